// Surfaces of triangles for three.js: from what the server sends to geometries with smooth flanks, sharp edges, and cut faces.
const CREASE = Math.cos((35 * Math.PI) / 180); // beyond which an edge is one

// Two numbers, of vertices and of triangles; then coordinates (mm), then corners.
export function surfaceOf(THREE, content) {
  const [vertices, triangles] = new Uint32Array(content, 0, 2);
  const places = new Float32Array(content, 8, 3 * vertices);
  const corners = new (vertices < 65536 ? Uint16Array : Uint32Array)(content, 8 + 12 * vertices, 3 * triangles);
  const normals = faceNormals(places, corners);
  const [begins, faces] = facesAtVertices(vertices, corners);
  const surface = new THREE.BufferGeometry();
  const [positions, shades] = [new Float32Array(9 * triangles), new Float32Array(9 * triangles)];
  for (let corner = 0; corner < corners.length; corner += 1) {
    const [vertex, own] = [corners[corner], 3 * Math.floor(corner / 3)];
    let [x, y, z] = [0, 0, 0];
    for (let n = begins[vertex]; n < begins[vertex + 1]; n += 1) {
      const other = 3 * faces[n];
      const [u, v, w] = [normals[other], normals[other + 1], normals[other + 2]];
      if (cosine(normals, own, other) >= CREASE) [x, y, z] = [x + u, y + v, z + w];
    }
    const size = Math.hypot(x, y, z) || 1;
    shades.set([x / size, y / size, z / size], 3 * corner);
    positions.set(places.subarray(3 * vertex, 3 * vertex + 3), 3 * corner);
  }
  surface.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  surface.setAttribute("normal", new THREE.BufferAttribute(shades, 3));
  const edges = new THREE.BufferGeometry();
  edges.setAttribute("position", new THREE.BufferAttribute(sharpEdges(places, corners, normals), 3));
  return { surface, edges };
}

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

function cosine(normals, one, other) {
  const [a, b, c] = [normals[one], normals[one + 1], normals[one + 2]];
  const [u, v, w] = [normals[other], normals[other + 1], normals[other + 2]];
  return (a * u + b * v + c * w) / (Math.sqrt((a * a + b * b + c * c) * (u * u + v * v + w * w)) || 1);
}

// The triangles at each vertex, one behind the other, and where each begins.
function facesAtVertices(vertices, corners) {
  const begins = new Uint32Array(vertices + 1);
  for (const vertex of corners) begins[vertex + 1] += 1;
  for (let n = 0; n < vertices; n += 1) begins[n + 1] += begins[n];
  const [next, faces] = [begins.slice(), new Uint32Array(corners.length)];
  for (let corner = 0; corner < corners.length; corner += 1) {
    const vertex = corners[corner];
    faces[next[vertex]] = Math.floor(corner / 3);
    next[vertex] += 1;
  }
  return [begins, faces];
}

function sharpEdges(places, corners, normals) {
  const [open, points] = [new Map(), []];
  const count = places.length / 3;
  for (let corner = 0; corner < corners.length; corner += 1) {
    const face = 3 * Math.floor(corner / 3);
    const [one, other] = [corners[corner], corners[corner % 3 === 2 ? corner - 2 : corner + 1]];
    const back = other * count + one;
    const mate = open.get(back);
    if (mate === undefined) {
      open.set(one * count + other, face);
      continue;
    }
    open.delete(back);
    if (cosine(normals, face, mate) < CREASE) for (const end of [one, other]) points.push(...places.subarray(3 * end, 3 * end + 3));
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
