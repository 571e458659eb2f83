// Surfaces of triangles for three.js: from what the server sends to geometries with smooth flanks, sharp edges, and cut faces.
const CREASE = Math.cos((35 * Math.PI) / 180); // beyond which an edge is one

// Two numbers, of vertices and of triangles; then coordinates (mm), then corners. A vertex is there once for each of its normals.
export function surfaceOf(THREE, content) {
  const [vertices, triangles] = new Uint32Array(content, 0, 2);
  const places = new Float32Array(content, 8, 3 * vertices);
  const corners = new (vertices < 65536 ? Uint16Array : Uint32Array)(content, 8 + 12 * vertices, 3 * triangles);
  const normals = faceNormals(places, corners);
  const [begins, around] = cornersAtVertices(vertices, corners);
  const [positions, shades] = [new Float32Array(9 * triangles), new Float32Array(9 * triangles)];
  const index = new Uint32Array(corners.length);
  let count = 0;
  for (let vertex = 0; vertex < vertices; vertex += 1) {
    const first = count;
    for (let n = begins[vertex]; n < begins[vertex + 1]; n += 1) {
      const own = faceOf(around[n]);
      let [x, y, z] = [0, 0, 0];
      for (let m = begins[vertex]; m < begins[vertex + 1]; m += 1) {
        const other = faceOf(around[m]);
        if (!isSmooth(normals, own, other)) continue;
        x += normals[other];
        y += normals[other + 1];
        z += normals[other + 2];
      }
      const size = Math.sqrt(x * x + y * y + z * z) || 1;
      [x, y, z] = [Math.fround(x / size), Math.fround(y / size), Math.fround(z / size)];
      let at = first;
      while (at < count && !(shades[3 * at] === x && shades[3 * at + 1] === y && shades[3 * at + 2] === z)) at += 1;
      index[around[n]] = at;
      if (at < count) continue;
      for (let axis = 0; axis < 3; axis += 1) positions[3 * at + axis] = places[3 * vertex + axis];
      shades[3 * at] = x;
      shades[3 * at + 1] = y;
      shades[3 * at + 2] = z;
      count += 1;
    }
  }
  const surface = new THREE.BufferGeometry();
  surface.setAttribute("position", new THREE.BufferAttribute(positions.slice(0, 3 * count), 3));
  surface.setAttribute("normal", new THREE.BufferAttribute(shades.slice(0, 3 * count), 3));
  surface.setIndex(new THREE.BufferAttribute(count < 65536 ? new Uint16Array(index) : index, 1));
  const edges = new THREE.BufferGeometry();
  edges.setAttribute("position", new THREE.BufferAttribute(sharpEdges(places, corners, normals, begins, around), 3));
  return { surface, edges };
}

// Where the normal of a corner's face stands.
const faceOf = (corner) => corner - (corner % 3);

// As long as their triangles are large, so that averages lean to the larger ones.
function faceNormals(places, corners) {
  const normals = new Float32Array(corners.length);
  for (let face = 0; face < corners.length; face += 3) {
    const [a, b, c] = [3 * corners[face], 3 * corners[face + 1], 3 * corners[face + 2]];
    const [x, y, z] = [places[b] - places[a], places[b + 1] - places[a + 1], places[b + 2] - places[a + 2]];
    const [u, v, w] = [places[c] - places[a], places[c + 1] - places[a + 1], places[c + 2] - places[a + 2]];
    normals[face] = y * w - z * v;
    normals[face + 1] = z * u - x * w;
    normals[face + 2] = x * v - y * u;
  }
  return normals;
}

// Whether there is no edge between two faces.
function isSmooth(normals, one, other) {
  const [a, b, c] = [normals[one], normals[one + 1], normals[one + 2]];
  const [u, v, w] = [normals[other], normals[other + 1], normals[other + 2]];
  return a * u + b * v + c * w >= CREASE * Math.sqrt((a * a + b * b + c * c) * (u * u + v * v + w * w));
}

// The corners at each vertex, one behind the other, and where each begins.
function cornersAtVertices(vertices, corners) {
  const begins = new Uint32Array(vertices + 1);
  for (let corner = 0; corner < corners.length; corner += 1) begins[corners[corner] + 1] += 1;
  for (let n = 0; n < vertices; n += 1) begins[n + 1] += begins[n];
  const [next, around] = [begins.slice(), new Uint32Array(corners.length)];
  for (let corner = 0; corner < corners.length; corner += 1) {
    around[next[corners[corner]]] = corner;
    next[corners[corner]] += 1;
  }
  return [begins, around];
}

// Both ends of each edge, which two faces have, one of them the other way round.
function sharpEdges(places, corners, normals, begins, around) {
  const following = (corner) => corners[corner % 3 === 2 ? corner - 2 : corner + 1];
  const points = [];
  for (let corner = 0; corner < corners.length; corner += 1) {
    const [one, other] = [corners[corner], following(corner)];
    if (one > other) continue;
    for (let n = begins[other]; n < begins[other + 1]; n += 1) {
      if (following(around[n]) !== one) continue;
      if (!isSmooth(normals, faceOf(corner), faceOf(around[n])))
        for (const end of [3 * one, 3 * other]) points.push(places[end], places[end + 1], places[end + 2]);
      break;
    }
  }
  return new Float32Array(points);
}

// What makes a cut body look solid: its back and front faces are counted where they are seen, and what is inside is covered.
export function cutOf(THREE, surface, colour, plane, order) {
  const counted = [THREE.BackSide, THREE.FrontSide].map((side) => {
    const op = side === THREE.BackSide ? THREE.IncrementWrapStencilOp : THREE.DecrementWrapStencilOp;
    const looks = { depthWrite: false, depthTest: false, colorWrite: false, stencilWrite: true, side, clippingPlanes: [plane] };
    const material = new THREE.MeshBasicMaterial({ ...looks, stencilFunc: THREE.AlwaysStencilFunc, stencilFail: op, stencilZFail: op, stencilZPass: op });
    const mesh = new THREE.Mesh(surface, material);
    mesh.renderOrder = order;
    return mesh;
  });
  const cover = { stencilWrite: true, stencilRef: 0, stencilFunc: THREE.NotEqualStencilFunc, side: THREE.DoubleSide };
  const zero = { stencilFail: THREE.ZeroStencilOp, stencilZFail: THREE.ZeroStencilOp, stencilZPass: THREE.ZeroStencilOp };
  const material = new THREE.MeshStandardMaterial({ color: colour, metalness: 0, roughness: 0.9, ...cover, ...zero });
  const cap = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), material);
  cap.renderOrder = order + 0.5;
  return { counted, cap };
}
