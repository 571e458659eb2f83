// What the hand does in the section: handles that write inputs, measures, and the tool that rolls over a tooth. The section lets it
// draw ("gear-section") and offers it each press ("gear-press"). Numbers are the server's. Lengths are in mm, angles in radians.
import { fixed, shown, shownNumber, shownUnit, stored } from "gear-units";

const REACH = 12; // pixels from a handle within which it is held
const APART = 70; // pixels between handles of one gear
const STEPS = [5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1]; // of the unit that is shown, to which values snap: not finer than a pixel
const FINEST = 0.01; // mm, or of a coefficient
const NUDGES = { mm: 0.1, in: 0.005 }; // change by a key; of a coefficient 0.01
const LONG = 4000; // pixels: half the length of a line that fills every window
const PATIENCE = 1500; // ms until a move that nobody answers is taken for lost
const PAUSE = 1000; // ms after which typing begins another step

const number = (text) => Number(text.trim().replace(",", "."));

export default {
  template: `
    <div class="section-tools" :hidden="!content?.gears.length">
      <div class="row">
        <select v-model="mode" :title="words.title" :aria-label="words.title" @change="ask(null)"><option v-for="each in modes" :key="each" :value="each">{{ words[each] }}</option></select>
        <select v-if="asksGear" :value="content.gear" :aria-label="words.gear" :title="words.gear" @change="gear = Number($event.target.value); ask(null)"><option v-for="(name, n) in content.gears" :key="n" :value="n">{{ name }}</option></select>
      </div>
      <div v-if="mode === 'draw'" class="row"><label v-for="handle in handles" :key="handle.key" :title="handle.words">{{ symbol(handle) }}
        <input type="text" inputmode="decimal" :aria-label="handle.words" :data-handle="handle.key" :value="shown(handle)" @change="type($event, handle)" @keydown.up.prevent="nudge($event, handle, 1)" @keydown.down.prevent="nudge($event, handle, -1)" />{{ unit(handle) }}</label></div>
      <div v-if="size !== null" class="row"><label>{{ mode === "pins" ? words.pin : words.diameter }}
        <input type="text" inputmode="decimal" class="size" :value="size" @change="askFor($event)" />{{ unit({ unit: "mm" }) }}</label></div>
      <div v-if="mode === 'tool' && content.tool" class="row">
        <button type="button" :aria-pressed="playing" :title="playing ? words.pause : words.play" @click="play">{{ playing ? "❚❚" : "▶" }}</button>
        <input type="range" min="0" :max="content.tool.turns.length - 1" step="1" v-model.number="at" :aria-label="words.step" />
      </div>
      <p v-for="line in lines" :key="line">{{ line }}</p>
      <p v-if="why" class="fault">{{ why }}</p>
    </div>`,
  props: { words: Object },
  emits: ["choose", "drawn"],
  data() {
    return { content: null, mode: "look", gear: 0, at: 0, playing: false, modes: ["look", "draw", "thickness", "gap", "pins", "tool"] };
  },
  computed: {
    handles() {
      return this.content?.handles ?? [];
    },
    asksGear() {
      const length = this.content?.gears.length ?? 0;
      return length > (this.mode === "draw" ? 2 : 1) && ["draw", "thickness", "pins", "tool"].includes(this.mode);
    },
    size() {
      const { thickness, pins } = this.content ?? {};
      return thickness ? shownNumber(thickness.diameter, 3, "mm") : pins ? shownNumber(pins.pin, 3, "mm") : null;
    },
    why() {
      return this.content?.pins?.why_not || this.content?.why_not || "";
    },
    lines() {
      const { thickness, pins, gap } = this.content ?? {};
      if (thickness) return [`${this.words.arc}: ${shown(thickness.arc, 4, "mm")}`, `${this.words.chord}: ${shown(thickness.chord, 4, "mm")}`];
      if (pins && !pins.why_not) return [`${pins.internal ? this.words.between : this.words.over}: ${shown(pins.over, 4, "mm")}`];
      if (gap) return [`${this.words.circumferential}: ${shown(gap.circumferential, 4, "mm")}`, `${this.words.line}: ${shown(gap.line_of_action, 4, "mm")}`, `${this.words.normal}: ${shown(gap.normal, 4, "mm")}`];
      return [];
    },
  },
  watch: { at: "redraw" },
  mounted() {
    [this.step, this.waiting, this.next, this.typed] = [0, false, null, {}];
    this.listening = new AbortController();
    const { signal } = this.listening;
    window.addEventListener("gear-section", this.paint, { signal });
    window.addEventListener("gear-press", this.press, { signal });
    window.addEventListener("gear-drag", this.drag, { signal });
    window.addEventListener("gear-drop", this.drop, { signal });
  },
  beforeUnmount() {
    this.listening.abort();
    clearTimeout(this.late);
    cancelAnimationFrame(this.frame);
  },
  methods: {
    show(content) {
      this.content = Object.freeze(content);
      if (this.content.tool) this.at = Math.min(this.at || (this.content.tool.turns.length - 1) / 2, this.content.tool.turns.length - 1);
      else if (this.playing) this.play();
      this.$el.dataset.mode = content.mode;
      this.go();
      this.redraw();
    },
    redraw() {
      window.dispatchEvent(new Event("gear-redraw"));
    },
    ask(size) {
      this.$emit("choose", { mode: this.mode, gear: this.gear, size });
    },
    askFor(event) {
      const size = number(event.target.value);
      if (size > 0) this.ask(stored(size, "mm"));
      else event.target.value = this.size;
    },
    play() {
      cancelAnimationFrame(this.frame);
      this.playing = !this.playing;
      let last = 0;
      const step = (now) => {
        if (now - last > 60 && this.content?.tool) {
          this.at = (this.at + 1) % this.content.tool.turns.length;
          last = now;
        }
        this.frame = requestAnimationFrame(step);
      };
      if (this.playing) this.frame = requestAnimationFrame(step);
    },
    // ---------------------------------------------------------------- drawing
    paint({ detail: { section, pen } }) {
      if (!section.content || !this.content) return;
      this.section = section;
      pen.setLineDash([]);
      const { thickness, pins, tool } = this.content;
      this.$el.dataset.places = this.handles.map((handle) => this.paintHandle(section, pen, handle)).join(" ");
      if (thickness) this.paintThickness(section, pen, thickness);
      if (pins?.circle) this.paintPins(section, pen, pins);
      if (tool) this.paintTool(section, pen, tool);
    },
    frameOf(section) {
      const number = this.content.body;
      const body = section.content.bodies[number];
      return { body, centre: section.place(body, section.turn), stand: section.stand(section.content, number, section.turn) };
    },
    symbol: ({ symbol }) => symbol.replace(/\d/g, (digit) => "₀₁₂₃₄₅₆₇₈₉"[digit]),
    // The direction in which a handle of a distance or a line moves.
    outward: (section, { direction, orbit }) => [Math.cos(direction + orbit * section.turn), Math.sin(direction + orbit * section.turn)],
    // Where a handle stands: on its circle, beside the middle of what is seen; that of a distance on the line of centres.
    placeOf(section, handle) {
      const body = section.content.bodies[handle.body];
      const centre = section.place(body, section.turn);
      if (handle.shape !== "circle") {
        const [cosine, sine] = this.outward(section, handle);
        const [x, y] = section.place(handle, section.turn);
        const beside = ((handle.kind === "tip_alteration" ? 2 : -2) * APART) / section.view.scale;
        return { centre, point: [x - sine * beside, y + cosine * beside] };
      }
      const towards = Math.atan2(section.view.y - centre[1], section.view.x - centre[0]);
      const side = (handle.kind === "tip_diameter" ? 1 : -1) * (Math.cos(towards) >= 0 ? 1 : -1);
      const angle = towards + (side * APART * (handle.body ? 0.5 : 1)) / (section.view.scale * handle.radius);
      return { centre, point: [centre[0] + handle.radius * Math.cos(angle), centre[1] + handle.radius * Math.sin(angle)] };
    },
    paintHandle(section, pen, handle) {
      const { centre, point } = this.placeOf(section, handle);
      const [x, y] = section.to(point);
      const held = this.held?.key === handle.key;
      [pen.strokeStyle, pen.lineWidth] = [section.colours.kept, held ? 2 : 1];
      pen.beginPath();
      if (handle.shape === "circle") pen.arc(...section.to(centre), handle.radius * section.view.scale, 0, 2 * Math.PI);
      if (handle.shape === "line") for (const end of [-LONG, LONG]) pen.lineTo(x, y + end);
      pen.stroke();
      [pen.fillStyle, pen.lineWidth] = [held ? section.colours.kept : section.colours.paper, 2];
      pen.beginPath();
      pen.rect(x - 6, y - 6, 12, 12);
      pen.fill();
      pen.stroke();
      this.label(section, pen, `${this.symbol(handle)} = ${this.shown(handle)} ${this.unit(handle)}`, x + 11, y + 4);
      return [x, y].map(Math.round).join();
    },
    label(section, pen, words, x, y) {
      pen.font = "13px system-ui, sans-serif";
      const width = pen.measureText(words).width;
      const left = x > section.$refs.canvas.clientWidth / 2 ? x - width - 24 : x; // fields are at the right
      [pen.fillStyle, pen.globalAlpha] = [section.colours.paper, 0.85];
      pen.fillRect(left - 3, y - 13, width + 6, 18);
      [pen.fillStyle, pen.globalAlpha] = [section.colours.ink, 1];
      pen.fillText(words, left, y);
    },
    paintThickness(section, pen, { diameter, half, arc }) {
      const { body, centre, stand } = this.frameOf(section);
      const pitch = (2 * Math.PI) / Math.abs(body.teeth);
      const towards = Math.atan2(section.view.y - centre[1], section.view.x - centre[0]);
      const middle = stand + pitch * Math.round((towards - stand) / pitch);
      pen.strokeStyle = section.colours.kept;
      pen.lineWidth = 3;
      pen.beginPath();
      pen.arc(...section.to(centre), (diameter / 2) * section.view.scale, -(middle - half), -(middle + half), true);
      pen.stroke();
      const [x, y] = section.to([centre[0] + (diameter / 2) * Math.cos(middle), centre[1] + (diameter / 2) * Math.sin(middle)]);
      this.label(section, pen, shown(arc, 3, "mm"), x + 10, y - 8);
    },
    paintPins(section, pen, { circle, pin, odd }) {
      const { body, centre, stand } = this.frameOf(section);
      const count = Math.abs(body.teeth);
      const pitch = (2 * Math.PI) / count;
      const towards = Math.atan2(section.view.y - centre[1], section.view.x - centre[0]);
      const first = stand + pitch * (Math.round((towards - stand) / pitch - 0.5) + 0.5);
      for (const angle of [first, first + pitch * ((count - odd) / 2)]) {
        pen.beginPath();
        pen.arc(...section.to([centre[0] + (circle / 2) * Math.cos(angle), centre[1] + (circle / 2) * Math.sin(angle)]), (pin / 2) * section.view.scale, 0, 2 * Math.PI);
        [pen.fillStyle, pen.strokeStyle, pen.lineWidth, pen.globalAlpha] = [section.colours.kept, section.colours.kept, 1.5, 0.25];
        pen.fill();
        pen.globalAlpha = 1;
        pen.stroke();
      }
    },
    // The tool where it was, thinly, and where it is.
    paintTool(section, pen, { stands }) {
      const { body, centre, stand } = this.frameOf(section);
      const pitch = (2 * Math.PI) / Math.abs(body.teeth);
      const towards = Math.atan2(section.view.y - centre[1], section.view.x - centre[0]);
      const turn = stand + pitch * Math.round((towards - stand) / pitch - 0.5);
      const [cosine, sine] = [Math.cos(turn), Math.sin(turn)];
      pen.strokeStyle = section.colours.kept;
      for (let n = 0; n <= this.at; n += 1) {
        const last = n === this.at;
        [pen.lineWidth, pen.globalAlpha] = last ? [2.5, 1] : [0.8, 0.45];
        for (const outline of stands[n]) {
          pen.beginPath();
          for (let k = 0; k < outline.length; k += 2) pen.lineTo(...section.to([centre[0] + cosine * outline[k] - sine * outline[k + 1], centre[1] + sine * outline[k] + cosine * outline[k + 1]]));
          pen.stroke();
        }
      }
      pen.globalAlpha = 1;
    },
    // ---------------------------------------------------------------- by hand
    press(event) {
      const { section, x, y } = event.detail;
      if (this.content?.thickness) {
        const { centre } = this.frameOf(section);
        const [u, v] = section.to(centre);
        const diameter = (2 * Math.hypot(x - u, y - v)) / section.view.scale;
        this.ask(Math.round(diameter * 100) / 100);
        return;
      }
      const near = this.handles.find((handle) => {
        const [u, v] = section.to(this.placeOf(section, handle).point);
        return Math.hypot(x - u, y - v) < REACH;
      });
      if (!near) return;
      event.preventDefault();
      this.step += 1;
      this.held = { ...near, from: [x, y] };
    },
    drag({ detail: { section, x, y } }) {
      if (!this.held) return;
      const { scale } = section.view;
      const [du, dv] = [(x - this.held.from[0]) / scale, -(y - this.held.from[1]) / scale];
      const { centre, point } = this.placeOf(section, this.held);
      const out = this.held.shape !== "circle" ? this.outward(section, this.held) : [point[0] - centre[0], point[1] - centre[1]].map((each) => each / this.held.radius);
      const moved = du * out[0] + dv * out[1];
      const { size } = shownUnit(this.held.unit);
      const least = Math.max(Math.abs(this.held.factor) / scale, size === 1 ? FINEST : 0) / size;
      const finest = STEPS.find((each) => each >= least) ?? 1;
      const value = (this.held.value + moved * this.held.factor) / size;
      this.push(this.held, Math.round(value / finest) * finest * size);
    },
    drop() {
      this.held = null;
      this.redraw();
    },
    shown: (handle) => (handle.unit ? shownNumber(handle.value, 3, handle.unit) : fixed(handle.value, 4)),
    unit: (handle) => shownUnit(handle.unit).name,
    type(event, handle) {
      const value = number(event.target.value);
      if (!event.target.value.trim() || !Number.isFinite(value)) return (event.target.value = this.shown(handle));
      this.step += 1;
      this.push(handle, stored(value, handle.unit));
    },
    nudge(event, handle, sign) {
      const now = performance.now();
      const goesOn = this.typed.key === handle.key && now - this.typed.at <= PAUSE;
      if (!goesOn) this.step += 1;
      const value = (goesOn ? this.typed.value : handle.value) + sign * stored(NUDGES[this.unit(handle)] ?? FINEST, handle.unit) * (event.shiftKey ? 10 : 1);
      this.typed = { key: handle.key, at: now, value };
      this.push(handle, value);
    },
    push({ key }, value) {
      this.next = { key, value, step: this.step };
      if (!this.waiting) this.go();
    },
    go() {
      clearTimeout(this.late);
      this.waiting = Boolean(this.next);
      if (!this.next) return;
      this.$emit("drawn", this.next);
      this.next = null;
      this.late = setTimeout(this.go, PATIENCE);
    },
  },
};
