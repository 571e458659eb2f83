// Colours of stresses, and what is drawn with them: teeth of the section on its canvas, teeth of bodies as surfaces of three.js.
const STOPS = [
  [59, 76, 192],
  [60, 155, 217],
  [88, 190, 120],
  [238, 200, 60],
  [236, 120, 40],
  [190, 20, 40],
];
const LEAST = 60; // pixels of a tooth pitch from which stresses are told beside contacts
const TINY = 5; // pixels of a tooth pitch below which no colours are seen

// Red, green and blue from 0 to 255 for a share from 0 to 1.
export function mixed(share) {
  const place = Math.min(Math.max(share, 0), 1) * (STOPS.length - 1);
  const n = Math.min(Math.floor(place), STOPS.length - 2);
  return STOPS[n].map((from, channel) => Math.round(from + (STOPS[n + 1][channel] - from) * (place - n)));
}
export const colourOf = (share) => `rgb(${mixed(share).join(" ")})`;
export const RAMP = `linear-gradient(to right, ${STOPS.map((_, n) => colourOf(n / (STOPS.length - 1))).join(", ")})`;
export const HEXES = STOPS.map((stop) => `#${stop.map((channel) => channel.toString(16).padStart(2, "0")).join("")}`);

// A value between those of rising places; null outside.
export function between(places, values, place) {
  const last = places.length - 1;
  if (last < 0 || !(place >= places[0] - 1e-9 && place <= places[last] + 1e-9)) return null;
  let [low, high] = [0, last];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (places[middle] <= place) low = middle;
    else high = middle;
  }
  const [from, to] = [values[low], values[high]];
  if (from === null || to === null) return from ?? to;
  const share = (place - places[low]) / (places[high] - places[low] || 1);
  return from + (to - from) * Math.min(Math.max(share, 0), 1);
}

// The roll angle (deg) of a check, within half a pitch of the pitch point, when the section has turned.
export function rollAngle(section, result) {
  const mesh = meshesOf(section, result)[0];
  if (!mesh) return 0;
  const place = placeOf(section, mesh, sideOf(section, mesh, result), 0);
  const from = (place - result.pitch_point) / result.base_pitch;
  return (((from - Math.round(from)) * result.base_pitch) / result.base) * (180 / Math.PI);
}

const meshesOf = (section, { mesh }) =>
  section.content.meshes.filter((_, n) => (mesh === null ? n === 0 : n % 2 === mesh));

// 1 where the flank that carries is the pinion's left one. That of a train is the one that touches.
const sideOf = (section, mesh, result) => (result.mesh === null ? result.side : (section.side || 1) * mesh.side);

// Where the flank of a pinion's tooth touches, or would: its roll length (mm).
function placeOf(section, mesh, side, tooth) {
  const body = section.content.bodies[mesh.of[0]];
  const pitch = (2 * Math.PI) / body.teeth;
  const angle = section.stand(section.content, mesh.of[0], section.turn) - mesh.towards - (mesh.orbit ?? 0) * section.turn;
  const turned = angle + tooth * pitch;
  return mesh.first + side * mesh.base * (turned - 2 * Math.PI * Math.round(turned / (2 * Math.PI)));
}

// Colours of one result on the teeth of the section: pressure where a contact passes the flank, tension of the root as it is now.
export function paintSection(section, pen, result, limits, told, fixed) {
  for (const mesh of meshesOf(section, result)) {
    const side = sideOf(section, mesh, result);
    const towards = mesh.towards + (mesh.orbit ?? 0) * section.turn;
    const origin = section.origin(mesh, section.turn);
    const on = (place) => {
      const [u, v] = turn([mesh.base, place], -mesh.angle);
      const [x, y] = turn([u, side * v], towards);
      return [origin[0] + x, origin[1] + y];
    };
    const pinion = section.content.bodies[mesh.of[0]];
    const places = Array.from({ length: pinion.teeth }, (_, tooth) => placeOf(section, mesh, side, tooth));
    const pitchPoint = result.pitch_point;
    for (const [n, role] of ["pinion", "wheel"].entries()) {
      const body = section.content.bodies[mesh.of[n]];
      const count = Math.abs(body.teeth);
      const pitch = (2 * Math.PI) / count;
      if ((pitch * body.circles.reference * section.view.scale) / 2 < TINY) continue;
      const [stand, place] = [section.stand(section.content, mesh.of[n], section.turn), section.place(body, section.turn)];
      const [x, y] = on(pitchPoint);
      const seen = Math.atan2(y - place[1], x - place[0]) - stand;
      const flank = Math.sign(seen - pitch * Math.round(seen / pitch)) || 1;
      const touching = n ? placesOfMate(body, mesh, side, stand, place, on, places, result, pitch) : places;
      for (let tooth = 0; tooth < count; tooth += 1)
        paintTooth(section, pen, body, place, stand + tooth * pitch, flank, result, role, touching[tooth], limits);
    }
    paintContacts(section, pen, result, places, on, limits, told, fixed);
  }
}

// Places of the teeth of the mate: that of the one which the pitch point lies on, and whole base pitches from it.
function placesOfMate(body, mesh, side, stand, centre, on, places, result, pitch) {
  const count = Math.abs(body.teeth);
  const order = body.teeth > 0 ? -side : side;
  const first = places.reduce((best, place) =>
    Math.abs(place - result.pitch_point) < Math.abs(best - result.pitch_point) ? place : best,
  );
  const [x, y] = on(first);
  const seen = (Math.atan2(y - centre[1], x - centre[0]) - stand) / pitch;
  const tooth = Math.round(seen);
  const found = new Array(count).fill(NaN);
  for (let k = -4; k <= 4; k += 1) found[(((tooth + order * k) % count) + count) % count] = first + k * result.base_pitch;
  return found;
}

function paintTooth(section, pen, body, centre, angle, flank, result, role, touching, limits) {
  const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
  const root = result.roots[role];
  const row = between(root.place, root.place.map((_, n) => n), touching);
  const tension = row === null ? null : root.radius.map((_, n) => between([0, 1], [root.stress[Math.floor(row)][n], root.stress[Math.ceil(row)][n]], row % 1));
  const { radius, pressure } = result.flanks[role];
  pen.setLineDash([]);
  pen.lineCap = "round";
  pen.lineWidth = Math.min(Math.max(section.view.scale * 0.12, 2), 6);
  let [former, formerRadius] = [null, 0];
  for (let k = 0; k < body.tooth.length; k += 2) {
    const [u, v] = [body.tooth[k], body.tooth[k + 1]];
    const size = Math.hypot(u, v);
    const point = v * flank >= 0 ? section.to([centre[0] + cosine * u - sine * v, centre[1] + sine * u + cosine * v]) : null;
    if (former && point) {
      const middle = (size + formerRadius) / 2;
      const pressed = between(radius, pressure, middle);
      const tensed = tension && between(root.radius, tension, middle);
      const share = pressed !== null ? pressed / limits.pressure : tensed !== null ? tensed / limits.root : null;
      if (share !== null) {
        pen.strokeStyle = colourOf(share);
        pen.beginPath();
        pen.moveTo(...former);
        pen.lineTo(...point);
        pen.stroke();
      }
    }
    [former, formerRadius] = [point, size];
  }
}

// Pressure and share of the load beside each contact.
function paintContacts(section, pen, result, places, on, limits, told, fixed) {
  if (result.base_pitch * section.view.scale < LEAST) return;
  const { place: known, pressure, share } = result.contacts;
  pen.font = "13px system-ui, sans-serif";
  for (const place of places) {
    const [pressed, carried] = [between(known, pressure, place), between(known, share, place)];
    if (carried === null) continue;
    const [x, y] = section.to(on(place));
    pen.beginPath();
    pen.arc(x, y, 5, 0, 2 * Math.PI);
    pen.fillStyle = pressed === null ? section.colours.soft : colourOf(pressed / limits.pressure);
    pen.strokeStyle = section.colours.ink;
    pen.lineWidth = 1.5;
    pen.fill();
    pen.stroke();
    const words = `${pressed === null ? "-" : told(pressed)}, ${fixed(100 * carried, 0)} %`;
    const width = pen.measureText(words).width;
    pen.fillStyle = section.colours.paper;
    pen.globalAlpha = 0.85;
    pen.fillRect(x - width - 18, y - 22, width + 8, 18);
    pen.globalAlpha = 1;
    pen.fillStyle = section.colours.ink;
    pen.fillText(words, x - width - 14, y - 8);
  }
}

const turn = ([x, y], angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];

// Coloured teeth of a body for three.js: one surface, as many times as there are teeth.
export function colouredTeeth(THREE, { points, triangles, values }, most, teeth) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
  const colours = new Float32Array(3 * values.length);
  const colour = new THREE.Color();
  values.forEach((value, n) => {
    const [red, green, blue] = mixed(value / most).map((channel) => channel / 255);
    colour.setRGB(red, green, blue, THREE.SRGBColorSpace).toArray(colours, 3 * n);
  });
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  geometry.setIndex(triangles);
  const looks = { vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 };
  const mesh = new THREE.InstancedMesh(geometry, new THREE.MeshBasicMaterial(looks), teeth);
  const matrix = new THREE.Matrix4();
  for (let n = 0; n < teeth; n += 1) mesh.setMatrixAt(n, matrix.makeRotationZ((2 * Math.PI * n) / teeth));
  mesh.frustumCulled = false;
  return mesh;
}
