// Draws every figure.tooth: drag turns it, the wheel with Ctrl or two fingers change its size; the wheel alone scrolls the page, a double click sets it back.
"use strict";

const vertexSource = `#version 300 es
in vec3 point; in float stress;
uniform mat3 turn; uniform vec2 scale; uniform float depth;
out vec3 seen; out float value;
void main() {
  seen = turn * point; value = stress;
  gl_Position = vec4(seen.xy * scale, -seen.z * depth, 1.0);
}`;

// Light from the viewer: normals come from the slopes of the surface on the screen.
const fragmentSource = `#version 300 es
precision highp float;
in vec3 seen; in float value;
uniform sampler2D colours;
out vec4 colour;
void main() {
  float facing = abs(normalize(cross(dFdx(seen), dFdy(seen))).z);
  colour = vec4(texture(colours, vec2((value * 255.0 + 0.5) / 256.0, 0.5)).rgb * (0.55 + 0.45 * facing), 1.0);
}`;

function unpacked(text) {
  return Uint8Array.from(atob(text), character => character.charCodeAt(0)).buffer;
}

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertexSource], [gl.FRAGMENT_SHADER, fragmentSource]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  gl.useProgram(made);
  return made;
}

function attribute(gl, made, name, data, size, type) {
  const place = gl.getAttribLocation(made, name);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, type, type === gl.UNSIGNED_BYTE, 0, 0);
}

function filled(gl, made, data) {
  attribute(gl, made, "point", unpacked(data.points), 3, gl.FLOAT);
  attribute(gl, made, "stress", unpacked(data.stress), 1, gl.UNSIGNED_BYTE);
  const triangles = unpacked(data.triangles);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, new Uint8Array(unpacked(data.colours)));
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.enable(gl.DEPTH_TEST);
  return triangles.byteLength / data.bytes;
}

// Rows to the right, up and towards us, of a tooth that stands upright: as the still picture has it. Columns for WebGL.
function turned(yaw, pitch) {
  const [a, b, c, d] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  return [0, c, d, -a, -d * b, c * b, b, -d * a, c * a];
}

function show(figure) {
  const canvas = figure.querySelector("canvas"), gl = canvas.getContext("webgl2", {antialias: true});
  if (!gl) return;
  const data = JSON.parse(figure.querySelector("script").textContent);
  const made = program(gl), count = filled(gl, made, data), type = data.bytes === 2 ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT;
  const start = {yaw: data.yaw * Math.PI / 180, pitch: data.pitch * Math.PI / 180, zoom: 1};
  let view = {...start}, waiting = false;

  function draw() {
    waiting = false;
    canvas.width = canvas.clientWidth * devicePixelRatio;
    canvas.height = canvas.clientHeight * devicePixelRatio;
    const scale = view.zoom * 0.95 / data.size, least = Math.min(canvas.width, canvas.height);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);  // the page's own colour shows
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix3fv(gl.getUniformLocation(made, "turn"), false, turned(view.yaw, view.pitch));
    gl.uniform2f(gl.getUniformLocation(made, "scale"), scale * least / canvas.width, scale * least / canvas.height);
    gl.uniform1f(gl.getUniformLocation(made, "depth"), 0.95 / data.size);
    gl.drawElements(gl.TRIANGLES, count, type, 0);
  }

  function redraw() {
    if (!waiting) requestAnimationFrame(draw);
    waiting = true;
  }

  figure.classList.add("turning");
  follow(canvas, start, () => view, changed => { view = changed; redraw(); });
  addEventListener("resize", redraw);
  draw();
}

function follow(canvas, start, view, change) {
  const fingers = new Map();
  const apart = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  const zoomed = factor => ({...view(), zoom: Math.min(12, Math.max(0.4, view().zoom * factor))});
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
  });
  canvas.addEventListener("pointermove", event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const distance = fingers.size === 2 ? apart() : 0, now = {x: event.clientX, y: event.clientY};
    fingers.set(event.pointerId, now);
    if (distance) return change(zoomed(apart() / distance));
    const pitch = view().pitch + (now.y - before.y) / 120;
    change({...view(), yaw: view().yaw + (now.x - before.x) / 120, pitch: Math.min(1.57, Math.max(-1.57, pitch))});
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  canvas.addEventListener("wheel", event => {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    change(zoomed(Math.exp(-event.deltaY / 500)));
  }, {passive: false});
  canvas.addEventListener("dblclick", () => change({...start}));
}

for (const figure of document.querySelectorAll("figure.tooth")) show(figure);
