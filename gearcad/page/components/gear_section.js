// The transverse section of the mesh, on a canvas: only what is seen is drawn. Lengths are in mm, angles in radians, y is up.
import { shown } from "gear-units";

const DASHES = { tip: [], reference: [8, 2, 1, 2], base: [4, 3], form: [1, 2], root: [], active: [2, 2], pitch: [10, 3, 2, 3] };
const BY_PROCESSOR = { willReadFrequently: true }; // a graphics card that is none takes seconds for dashes and outlines
const NEAR = 5; // pixels from a circle within which it is meant

// Between the pairs of a table [[height, value], ...].
function at(table, height) {
  let n = 1;
  while (n < table.length - 1 && table[n][0] < height) n += 1;
  if (table.length < 2) return table[0][1];
  const [[low, from], [high, to]] = [table[n - 1], table[n]];
  return from + ((to - from) * (height - low)) / (high - low || 1);
}
const turned = ([x, y], angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];


export default {
  template: `
    <div class="gear-section">
      <canvas ref="canvas" tabindex="0" role="img" :aria-label="label" @wheel.prevent="wheel" @pointerdown="press" @pointermove="move" @pointerup="release" @pointercancel="release" @pointerleave="told = ''" @dblclick="near = !near; fit()" @keydown="key"></canvas>
      <div class="tools" v-if="content">
        <button type="button" @click="near = false; fit()">{{ words.fit }}</button>
        <button type="button" v-if="content.meshes.length" @click="near = true; fit()">{{ words.mesh }}</button>
        <select v-if="content.meshes.length" v-model="flanks" :title="words.flanks" :aria-label="words.flanks"><option v-for="each in ['left', 'right']" :key="each" :value="each">{{ words[each] }}: {{ content.bodies[0].name }}</option><option value="both">{{ words.both }}</option></select>
        <label v-if="helical" :title="words.height">z <input type="range" min="0" max="1" step="0.005" v-model.number="share" :aria-label="words.height" /> {{ shown(height, 2, "mm") }}</label>
      </div>
      <p class="told" v-if="told" :style="toldAt">{{ told }}</p>
      <p class="nothing" v-if="empty">{{ words.nothing }}</p>
    </div>`,
  props: { label: String, words: Object },
  data() {
    return { content: null, kept: null, empty: false, near: true, flanks: "left", share: 0, told: "", toldAt: {} };
  },
  computed: {
    side() {
      return { left: 1, right: -1, both: 0 }[this.flanks];
    },
    helical() {
      return this.content.bodies.some(({ turns }) => turns.some(([, turn]) => turn !== turns[0][1]));
    },
    height() {
      const [low, high] = this.content.heights;
      return low + (high - low) * this.share;
    },
  },
  watch: { flanks: "draw", share: "draw" },
  mounted() {
    this.turn = 0;
    this.fingers = new Map();
    this.view = { x: 0, y: 0, scale: 1 };
    this.colours = {};
    this.observers = [new ResizeObserver(this.resize), new MutationObserver(this.restyle)];
    this.observers[0].observe(this.$el);
    this.observers[1].observe(document.body, { attributeFilter: ["class"] });
    window.addEventListener("gear-turn", this.roll);
    window.addEventListener("gear-redraw", this.draw);
    this.restyle();
  },
  beforeUnmount() {
    for (const observer of this.observers) observer.disconnect();
    window.removeEventListener("gear-turn", this.roll);
    window.removeEventListener("gear-redraw", this.draw);
    cancelAnimationFrame(this.drawing);
  },
  methods: {
    shown,
    show(content, kept) {
      const former = this.extent();
      [this.content, this.kept, this.empty] = [content && Object.freeze(content), kept && Object.freeze(kept), !content];
      const extent = this.extent();
      const other = !former || !extent || Math.abs(Math.log(extent.width / former.width)) > 0.2 || former.count !== extent.count;
      if (extent && former?.count !== extent.count) this.near = extent.count <= 2;
      if (extent && other) this.fit();
      this.$el.dataset.teeth = content ? content.bodies.map((body) => body.teeth ?? 0).join(" ") : "";
      this.draw();
    },
    clear() {
      this.show(null, null);
      this.empty = false;
    },
    // The mesh of a planet goes round with it, and so does the eye that looks at it.
    roll(event) {
      const orbit = (this.near && this.content?.meshes[0]?.orbit) || 0;
      const [x, y] = turned([this.view.x, this.view.y], orbit * (event.detail.turn - this.turn));
      [this.turn, this.view] = [event.detail.turn, { ...this.view, x, y }];
      this.draw();
    },
    // ---------------------------------------------------------------- where things stand
    extent() {
      if (!this.content) return null;
      const boxes = this.content.bodies.map((body) => {
        if (!body.teeth) {
          const [x, y] = body.place;
          return body.angle ? [x - body.circles.tip, y, x + body.height, y] : [x, y - body.height, x + body.length, y + body.circles.tip];
        }
        const half = Math.max(body.rim ?? 0, body.circles.tip, body.circles.root) / 2;
        return [body.place[0] - half, body.place[1] - half, body.place[0] + half, body.place[1] + half];
      });
      const [left, bottom] = [0, 1].map((n) => Math.min(...boxes.map((box) => box[n])));
      const [right, top] = [2, 3].map((n) => Math.max(...boxes.map((box) => box[n])));
      return { x: (left + right) / 2, y: (bottom + top) / 2, width: right - left, height: top - bottom, count: boxes.length };
    },
    fit() {
      const { clientWidth: width, clientHeight: height } = this.$refs.canvas;
      if (!this.content || !width) return;
      const mesh = this.near && this.content.meshes[0];
      if (mesh) {
        const [x, y] = this.origin(mesh, this.turn);
        const towards = mesh.towards + (mesh.orbit ?? 0) * this.turn;
        const reach = Math.max(mesh.path[4] - mesh.path[0], mesh.pitch) * 1.5;
        const pitch = mesh.base / Math.cos(mesh.angle);
        this.view = { x: x + pitch * Math.cos(towards), y: y + pitch * Math.sin(towards), scale: Math.min(width, height) / reach };
      } else {
        const extent = this.extent();
        this.view = { x: extent.x, y: extent.y, scale: 0.94 * Math.min(width / extent.width, height / extent.height) };
      }
      this.fitted = true; // until somebody moves it
      this.draw();
    },
    place(body, turn) {
      return turned(body.place, (body.orbit ?? 0) * turn);
    },
    // How far a body is turned, or a rack moved, at this height; it goes up to the flanks that touch.
    stand(content, number, turn) {
      const body = content.bodies[number];
      return at(body.turns, this.height) + (body.ratio + (body.orbit ?? 0)) * turn + this.side * body.slack;
    },
    origin(mesh, turn) {
      return this.place(this.content.bodies[mesh.of[0]], turn);
    },
    // ---------------------------------------------------------------- drawing
    restyle() {
      const style = getComputedStyle(document.body);
      for (const name of ["ink", "soft", "wrong", "paper", "kept"]) this.colours[name] = style.getPropertyValue(`--${name}`).trim();
      this.draw();
    },
    resize() {
      const canvas = this.$refs.canvas;
      const [width, height, ratio] = [canvas.clientWidth, canvas.clientHeight, window.devicePixelRatio];
      if (!width || !height) return;
      const first = !this.sized;
      [canvas.width, canvas.height, this.sized] = [width * ratio, height * ratio, true];
      if (first || this.fitted) this.fit();
      this.draw();
    },
    draw() {
      if (!this.drawing) this.drawing = requestAnimationFrame(this.paint);
    },
    paint() {
      this.drawing = 0;
      const canvas = this.$refs.canvas;
      if (!canvas?.width) return;
      const pen = canvas.getContext("2d", BY_PROCESSOR);
      pen.setTransform(window.devicePixelRatio, 0, 0, window.devicePixelRatio, 0, 0);
      pen.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
      if (!this.content) return;
      const middle = [canvas.clientWidth / 2, canvas.clientHeight / 2];
      const { x, y, scale } = this.view;
      this.to = (point) => [middle[0] + (point[0] - x) * scale, middle[1] - (point[1] - y) * scale];
      this.content.bodies.forEach((body, number) => this.body(pen, this.content, number, body.colour));
      this.kept?.bodies.forEach((_, number) => this.body(pen, this.kept, number, null));
      this.content.bodies.forEach((body) => this.circles(pen, body));
      for (const mesh of this.content.meshes) this.mesh(pen, mesh);
      window.dispatchEvent(new CustomEvent("gear-section", { detail: { section: this, pen } })); // others draw over it
      canvas.dataset.turn = this.turn;
    },
    body(pen, content, number, colour) {
      const body = content.bodies[number];
      const [turn, place] = [this.stand(content, number, this.turn), this.place(body, this.turn)];
      pen.beginPath();
      const points = body.teeth ? this.chain(pen, body, place, turn) : this.teeth(body, place, turn);
      points.forEach((point, n) => (n ? pen.lineTo(...point) : pen.moveTo(...point)));
      if (colour && body.teeth) this.back(pen, body, place, turn - at(body.turns, this.height) + body.rest);
      else if (!body.teeth || this.whole) pen.closePath();
      pen.strokeStyle = colour ?? this.colours.kept;
      pen.setLineDash(colour ? [] : [5, 3]);
      pen.lineWidth = colour ? 1.4 : 1;
      if (colour) {
        pen.fillStyle = colour;
        pen.globalAlpha = 0.28;
        pen.fill("evenodd");
        pen.globalAlpha = 1;
      }
      pen.stroke();
    },
    // The outline over the teeth that are seen, on the screen.
    chain(pen, body, place, turn) {
      const count = Math.abs(body.teeth);
      const pitch = (2 * Math.PI) / count;
      const [x, y] = [this.view.x - place[0], this.view.y - place[1]];
      const [away, reach] = [Math.hypot(x, y), this.reach()];
      let [first, last] = [0, count - 1];
      const half = away > reach ? Math.asin(reach / away) : Math.PI;
      this.whole = half + pitch >= Math.PI;
      if (!this.whole) {
        const middle = Math.atan2(y, x) - turn;
        [first, last] = [Math.floor((middle - half) / pitch), Math.ceil((middle + half) / pitch)];
      }
      const points = [];
      for (let n = first; n <= last; n += 1) {
        const [cosine, sine] = [Math.cos(turn + n * pitch), Math.sin(turn + n * pitch)];
        for (let k = 0; k < body.tooth.length; k += 2) {
          const [u, v] = [body.tooth[k], body.tooth[k + 1]];
          points.push(this.to([place[0] + cosine * u - sine * v, place[1] + sine * u + cosine * v]));
        }
      }
      this.ends = [turn + (first - 0.5) * pitch, turn + (last + 0.5) * pitch];
      return points;
    },
    // From the end of the outline to its beginning: round the bore with its keyway, or the rim; then bolt holes.
    back(pen, body, place, rest) {
      const [diameter, keyway] = body.teeth > 0 ? [body.bore, body.keyway] : [body.rim ?? 0, [0, 0]];
      const [from, to] = this.whole ? [rest + Math.PI, rest - Math.PI] : [this.ends[1], this.ends[0]];
      if (this.whole) pen.closePath();
      if (body.spline) this.splined(pen, place, body.spline, rest, from, to);
      else if (diameter) this.hole(pen, place, diameter / 2, keyway, rest, from, to);
      else if (!this.whole && body.teeth > 0) pen.lineTo(...this.to(place));
      const [circle, count, bolt] = body.bolts;
      for (let n = 0; n < count; n += 1) {
        const [x, y] = turned([circle / 2, 0], rest + (2 * Math.PI * n) / count);
        const [u, v] = this.to([place[0] + x, place[1] + y]);
        const radius = (bolt / 2) * this.view.scale;
        pen.moveTo(u + radius, v);
        pen.arc(u, v, radius, 0, 2 * Math.PI);
      }
    },
    // Clockwise from an angle down to another, into the keyway where it is passed.
    hole(pen, place, radius, [width, depth], rest, from, to) {
      const half = width ? Math.asin(width / 2 / radius) : 0;
      const at = rest + 2 * Math.PI * Math.floor((from - half - rest) / (2 * Math.PI)); // the first keyway that is met whole
      const arc = (begin, end) => pen.arc(...this.to(place), radius * this.view.scale, -begin, -end, false);
      const on = (u, v) => pen.lineTo(...this.to(turned([u, v], at).map((each, n) => each + place[n])));
      if (this.whole) pen.moveTo(...this.to(turned([radius, 0], from).map((each, n) => each + place[n])));
      if (!half || at - half < to) arc(from, to);
      else {
        arc(from, at + half);
        for (const side of [1, -1]) on(radius + depth, (side * width) / 2);
        arc(at - half, to);
      }
      pen.closePath();
    },
    // Clockwise along the teeth of a splined bore, from one near an angle down to one near another.
    splined(pen, place, [count, tooth], rest, from, to) {
      const pitch = (2 * Math.PI) / count;
      const [first, last] = this.whole ? [count - 1, 0] : [from, to].map((angle) => Math.round((angle - rest) / pitch));
      for (let n = first; n >= last; n -= 1) {
        for (let k = tooth.length - 2; k >= 0; k -= 2) {
          const [x, y] = turned([tooth[k], tooth[k + 1]], rest + n * pitch);
          const point = this.to([place[0] + x, place[1] + y]);
          if (this.whole && n === first && k === tooth.length - 2) pen.moveTo(...point);
          else pen.lineTo(...point);
        }
      }
      pen.closePath();
    },
    // A rack as far as it is seen: its teeth drift along it over the height, its ends do not.
    teeth(body, place, travel) {
      const drift = at(body.turns, this.height) - body.turns[0][1];
      const shift = travel - drift;
      const reach = 2 * this.reach();
      const along = turned([this.view.x - place[0], this.view.y - place[1]], -body.angle)[0] - shift;
      const [from, to] = [Math.max(0, along - reach), Math.min(body.length, along + reach)];
      const points = [[from, -body.height]];
      for (let n = Math.floor((from - drift) / body.pitch) - 1; n * body.pitch + drift <= to + body.pitch; n += 1)
        for (let k = 0; k < body.tooth.length; k += 2) {
          const u = body.tooth[k] + (n + 0.5) * body.pitch + drift;
          if (u >= from && u <= to) points.push([u, body.tooth[k + 1]]);
        }
      points.push([to, -body.height]);
      return points.map(([u, v]) => turned([u + shift, v], body.angle)).map(([u, v]) => this.to([u + place[0], v + place[1]]));
    },
    // Circles, and lines of a rack, as far as they are seen: dashes that nobody sees take their time all the same.
    circles(pen, body) {
      pen.strokeStyle = this.colours.soft;
      pen.lineWidth = 0.8;
      const place = this.place(body, this.turn);
      const [x, y] = turned([this.view.x - place[0], this.view.y - place[1]], -(body.angle ?? 0));
      const [away, reach] = [Math.hypot(x, y), this.reach()];
      const half = away > reach ? Math.asin(reach / away) : Math.PI;
      const first = Math.atan2(y, x) - half;
      for (const [kind, size] of Object.entries(body.circles)) {
        const radius = (size / 2) * this.view.scale;
        if (body.teeth && Math.abs(away - size / 2) > reach) continue;
        pen.setLineDash(DASHES[kind]);
        pen.lineDashOffset = body.teeth ? first * radius : (x - reach) * this.view.scale;
        pen.beginPath();
        if (body.teeth) pen.arc(...this.to(place), radius, -first, -first - 2 * half, true);
        else
          for (const u of [x - reach, x + reach])
            pen.lineTo(...this.to(turned([u, size], body.angle).map((each, n) => each + place[n])));
        pen.stroke();
      }
      pen.lineDashOffset = 0;
    },
    // How far the corners of the view are from its middle (mm).
    reach() {
      const { clientWidth: width, clientHeight: height } = this.$refs.canvas;
      return Math.hypot(width, height) / 2 / this.view.scale;
    },
    // Lines of action and paths of contact of both flanks; T1 on the pinion's base circle is where lengths begin.
    mesh(pen, mesh) {
      const [x, y] = this.origin(mesh, this.turn);
      const towards = mesh.towards + (mesh.orbit ?? 0) * this.turn;
      const driven = this.side * mesh.side;
      for (const side of driven ? [driven] : [1, -1]) {
        const on = (s) => {
          const [u, v] = turned([mesh.base, s], -mesh.angle);
          const [across, along] = turned([u, side * v], towards);
          return this.to([x + across, y + along]);
        };
        const line = (from, to, colour, width) => {
          [pen.strokeStyle, pen.lineWidth] = [colour, width];
          pen.setLineDash([]);
          pen.beginPath();
          pen.moveTo(...on(from));
          pen.lineTo(...on(to));
          pen.stroke();
        };
        const [A, B, C, D, E] = mesh.path;
        line(Math.min(0, A), Math.max(E, mesh.length ?? E), this.colours.wrong, 1);
        line(A, E, this.colours.ink, 2.2);
        [pen.fillStyle, pen.font] = [this.colours.ink, "13px system-ui, sans-serif"];
        const named = { A, B, C, D, E, T1: 0, ...(mesh.length > 0 ? { T2: mesh.length } : {}) };
        if (this.view.scale * (E - A) > 60 && side === (driven || 1))
          for (const [name, s] of Object.entries(named)) {
            const [u, v] = on(s);
            pen.fillRect(u - 1.5, v - 1.5, 3, 3);
            pen.fillText(name, u + 6, v + 3);
          }
        if (driven) this.touches(pen, mesh, side, towards, on);
      }
    },
    // Points where flanks touch: those of all teeth are base pitches apart, and move on by the base radius times the turn.
    touches(pen, mesh, side, towards, on) {
      const angle = this.stand(this.content, mesh.of[0], this.turn) - towards;
      const [A, , , , E] = mesh.path;
      const s = mesh.first + side * mesh.base * angle;
      for (let k = Math.ceil((A - s) / mesh.pitch); s + k * mesh.pitch <= E; k += 1) {
        pen.beginPath();
        pen.arc(...on(s + k * mesh.pitch), 4, 0, 2 * Math.PI);
        [pen.fillStyle, pen.strokeStyle, pen.lineWidth] = [this.colours.wrong, this.colours.paper, 1.5];
        pen.fill();
        pen.stroke();
      }
    },
    // ---------------------------------------------------------------- by hand
    zoom(factor, x, y) {
      const canvas = this.$refs.canvas;
      const [u, v] = [(x - canvas.clientWidth / 2) / this.view.scale, (canvas.clientHeight / 2 - y) / this.view.scale];
      const scale = Math.min(Math.max(this.view.scale * factor, 1e-3), 1e6);
      const kept = 1 - this.view.scale / scale;
      this.fitted = false;
      this.view = { x: this.view.x + u * kept, y: this.view.y + v * kept, scale };
      this.draw();
    },
    pan(x, y) {
      this.fitted = false;
      this.view = { ...this.view, x: this.view.x - x / this.view.scale, y: this.view.y + y / this.view.scale };
      this.draw();
    },
    wheel(event) {
      this.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.04 : 0.0015)), event.offsetX, event.offsetY);
    },
    press(event) {
      event.target.setPointerCapture(event.pointerId);
      this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
      this.lent = this.fingers.size === 1 && !this.offer("gear-press", event);
    },
    release(event) {
      this.fingers.delete(event.pointerId);
      if (this.lent) this.offer("gear-drop", event);
      this.lent = false;
    },
    // Whether nobody else takes what the pointer does.
    offer(name, { offsetX: x, offsetY: y }) {
      return window.dispatchEvent(new CustomEvent(name, { cancelable: true, detail: { section: this, x, y } }));
    },
    move(event) {
      const point = [event.offsetX, event.offsetY];
      if (this.lent) return void this.offer("gear-drag", event);
      const former = this.fingers.get(event.pointerId);
      if (!former) return this.tell(point);
      this.told = "";
      this.fingers.set(event.pointerId, point);
      const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        const apart = (from) => Math.hypot(from[0] - other[0], from[1] - other[1]);
        this.zoom(apart(point) / (apart(former) || 1), (point[0] + other[0]) / 2, (point[1] + other[1]) / 2);
      }
      this.pan((point[0] - former[0]) / (other ? 2 : 1), (point[1] - former[1]) / (other ? 2 : 1));
    },
    // The circle under the pointer, with its diameter.
    tell([x, y]) {
      if (!this.content || !this.to) return;
      let [best, text] = [NEAR, ""];
      for (const body of this.content.bodies)
        for (const [kind, size] of Object.entries(body.circles)) {
          if (!body.teeth) continue;
          const [u, v] = this.to(this.place(body, this.turn));
          const off = Math.abs(Math.hypot(x - u, y - v) - (size / 2) * this.view.scale);
          if (off < best) [best, text] = [off, `${body.name}: ${this.words[kind]} ${shown(size, 4, "mm")}`];
        }
      [this.told, this.toldAt] = [text, { left: `${x + 12}px`, top: `${y + 12}px` }];
    },
    key(event) {
      const steps = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] };
      const canvas = this.$refs.canvas;
      if (event.key in steps) this.pan(...steps[event.key]);
      else if ("+-".includes(event.key)) this.zoom(event.key === "+" ? 1.25 : 0.8, canvas.clientWidth / 2, canvas.clientHeight / 2);
      else return;
      event.preventDefault();
    },
  },
};
