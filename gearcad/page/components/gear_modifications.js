// Diagrams of a gear's flanks with handles, and the transmission error that comes of them. Curves are the server's; handles send
// what they say, one move at a time. Lengths are in mm, amounts in µm; material that is taken off is drawn downwards.
import { fixed, shown, shownNumber, shownUnit, stored } from "gear-units";

const LEFT = 52, RIGHT = 14, TOP = 22, BOTTOM = 40, HIGH = 160;
const PATIENCE = 1500; // ms until a move that nobody answers is taken for lost
const PAUSE = 1000; // ms after which keys begin another step
const LEAST_SCALE = 20; // µm that a diagram has at least
const SHARE = 0.25; // place of the handle of a crowning, where it has a quarter of its amount
const DEFAULT_LENGTH = 0.3; // share of the flank of a relief that had no length

const isLength = (name) => name.endsWith("_length");
const told = (name, value) => (isLength(name) ? shown(value, 2, "mm") : shown(value, 1, "µm"));
const nice = (value) => {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((each) => each * power >= value) * power;
};

export default {
  template: `
    <div class="gear-modifications">
      <p v-if="!content" class="none">{{ words.none }}</p>
      <template v-else>
        <div class="which" role="group" :aria-label="words.gear">
          <button v-for="(each, n) in content.gears" :key="each.role" type="button" :aria-pressed="chosen === n" @click="chosen = n">{{ words[each.role] }}</button>
        </div>
        <figure>
          <figcaption>{{ words.error }} ({{ unit("") }})</figcaption>
          <p v-if="content.error.why_not" class="fault">{{ content.error.why_not }}</p>
          <template v-else>
            <p class="peak"><span>{{ words.peak }}:</span> <span v-if="former" class="former">{{ words.before }} {{ peak(former) }}</span> <b>{{ former ? words.after : "" }} {{ peak(content.error) }}</b></p>
            <svg :width="width" :height="high" role="img" :aria-label="words.error + ', ' + peak(content.error)">
              <g class="axes">
                <line v-for="tick in course.up" :key="tick.y" :x1="left" :x2="width - right" :y1="tick.y" :y2="tick.y" />
                <text v-for="tick in course.up" :key="'t' + tick.y" :x="left - 12" :y="tick.y + 4" text-anchor="end">{{ tick.words }}</text>
                <text v-for="tick in course.across" :key="'t' + tick.x" :x="tick.x" :y="high - bottom + 14" text-anchor="middle">{{ tick.words }}</text>
                <text :x="(left + width - right) / 2" :y="high - 6" text-anchor="middle">{{ words.angle }} (°)</text>
              </g>
              <polyline v-if="former" class="curve former" :points="course.former" /><polyline class="curve" :points="course.points" />
            </svg>
            <p class="hint">{{ words.model }}</p>
          </template>
        </figure>
        <figure v-for="diagram in diagrams" :key="diagram.key">
          <figcaption>{{ words[diagram.key] }} ({{ unit("") }})</figcaption>
          <svg :width="width" :height="high" role="group" :aria-label="words[diagram.key]" @pointermove="drag" @pointerup="drop" @pointercancel="drop">
            <g class="axes">
              <line v-for="tick in diagram.up" :key="tick.y" :x1="left" :x2="width - right" :y1="tick.y" :y2="tick.y" :class="{ zero: !tick.value }" />
              <text v-for="tick in diagram.up" :key="'t' + tick.y" :x="left - 12" :y="tick.y + 4" text-anchor="end">{{ tick.words }}</text>
              <line v-for="tick in diagram.across" :key="tick.x" :x1="tick.x" :x2="tick.x" :y1="top" :y2="high - bottom" />
              <text v-for="tick in diagram.across" :key="'t' + tick.x" :x="tick.x" :y="high - bottom + 14" text-anchor="middle">{{ tick.words }}</text>
              <text :x="left" :y="high - 6">{{ diagram.from }}</text><text :x="(left + width - right) / 2" :y="high - 6" text-anchor="middle">{{ diagram.title }}</text><text :x="width - right" :y="high - 6" text-anchor="end">{{ diagram.to }}</text>
            </g>
            <polyline class="curve" :points="diagram.points" />
            <g v-for="handle in diagram.handles" :key="handle.name" class="handle" :class="{ across: handle.across }" tabindex="0" role="slider" :data-handle="handle.name" :aria-label="words[handle.name]" :aria-valuenow="handle.value" :aria-valuetext="handle.told" @pointerdown.prevent="grab($event, diagram, handle)" @keydown="key($event, handle)">
              <title>{{ words[handle.name] }}: {{ handle.told }}</title>
              <circle class="reach" :cx="handle.x" :cy="handle.y" r="14" /><circle class="dot" :cx="handle.x" :cy="handle.y" r="6" />
            </g>
            <text v-if="beside && beside.key === diagram.key" class="beside" :x="beside.x" :y="beside.y" :text-anchor="beside.anchor">{{ beside.words }}</text>
          </svg>
        </figure>
        <p class="hint">{{ words.hint }}</p>
        <div class="numbers">
          <label v-for="(value, name) in values" :key="name"><span>{{ words[name] }}</span>
            <input type="text" inputmode="decimal" :data-field="name" :value="number(name, value)" @change="type($event, name)" @keydown.enter="type($event, name)" /><i>{{ unit(name) }}</i></label>
        </div>
      </template>
    </div>`,
  props: { words: Object },
  emits: ["drawn", "released"],
  data() {
    return { content: null, former: null, chosen: 0, width: 300, scales: null, beside: null, left: LEFT, right: RIGHT, top: TOP, bottom: BOTTOM, high: HIGH };
  },
  computed: {
    gear() {
      return this.content.gears[Math.min(this.chosen, this.content.gears.length - 1)];
    },
    values() {
      return this.gear.values;
    },
    diagrams() {
      return ["profile", "lead"].map(this.diagram);
    },
    course() {
      const { angles, errors } = this.content.error;
      const every = this.former ? [...errors, ...this.former.errors] : errors;
      const [low, high] = [Math.min(...every), Math.max(...every)];
      const room = Math.max((high - low) * 0.08, 0.05);
      const [from, to] = [Math.min(...angles), Math.max(...angles)];
      const x = (angle) => LEFT + ((angle - from) / (to - from || 1)) * (this.width - LEFT - RIGHT);
      const y = (error) => TOP + ((high + room - error) / (high - low + 2 * room)) * (HIGH - TOP - BOTTOM);
      const line = ({ angles: at, errors: values }) => at.map((angle, n) => `${x(Math.min(Math.max(angle, from), to)).toFixed(1)},${y(values[n]).toFixed(1)}`).join(" ");
      const up = [low, (low + high) / 2, high].map((value) => ({ y: y(value), words: shownNumber(value, 2, "µm") }));
      const across = [-1, 0, 1].map((share) => ({ x: x((share * to) / 1.25), words: fixed((share * to) / 1.25, 1) }));
      return { up, across, points: line(this.content.error), former: this.former && line(this.former) };
    },
  },
  mounted() {
    [this.step, this.waiting, this.next, this.keyed] = [0, false, null, {}];
    this.observer = new ResizeObserver(() => (this.width = Math.max(this.$el.clientWidth - 16, 240)));
    this.observer.observe(this.$el);
  },
  beforeUnmount() {
    this.observer.disconnect();
    clearTimeout(this.late);
  },
  methods: {
    // What the server found; the next move may go to it. Without gears there is nothing to hold.
    show(content, before) {
      [this.content, this.former] = [content && Object.freeze(content), before?.angles?.length ? Object.freeze(before) : null];
      if (!content) this.held = null;
      this.$el.dataset.peak = content?.error.peak_to_peak ?? "";
      this.go();
    },
    heard() {
      clearTimeout(this.late);
      this.late = setTimeout(this.go, PATIENCE);
    },
    peak(error) {
      return shown(error.peak_to_peak, 2, "µm");
    },
    unit: (name) => shownUnit(isLength(name) ? "mm" : "µm").name,
    number: (name, value) => (isLength(name) ? shownNumber(value, 2, "mm") : shownNumber(value, 1, "µm")),
    // ---------------------------------------------------------------- drawing
    diagram(key) {
      const gear = this.gear;
      const [from, to] = key === "profile" ? [gear.first, gear.last] : [0, gear.width];
      const curve = gear[key];
      const scale = this.scales?.[key] ?? stored(nice(Math.max(LEAST_SCALE, 1.2 * Math.max(...curve.map(Math.abs))) / shownUnit("µm").size), "µm");
      const lowest = Math.min(...curve) < -0.5 ? -scale : -scale / 5;
      const x = (place) => LEFT + ((place - from) / (to - from)) * (this.width - LEFT - RIGHT);
      const y = (amount) => TOP + ((amount - lowest) / (scale - lowest)) * (HIGH - TOP - BOTTOM);
      const points = curve.map((amount, n) => `${x(from + ((to - from) * n) / (curve.length - 1)).toFixed(1)},${y(amount).toFixed(1)}`).join(" ");
      const up = (lowest === -scale ? [-1, -0.5, 0, 0.5, 1] : [0, 0.5, 1]).map((share) => ({ value: share, y: y(share * scale), words: shownNumber(-share * scale + 0, scale < 10 ? 1 : 0, "µm") }));
      const across = (key === "profile" ? [0.2, 0.8] : [0.1, 0.5, 0.9]).map((share) => {
        const place = from + share * (to - from);
        return { x: x(place), words: key === "profile" ? `${shownNumber(Math.abs(place), 1, "mm")} (⌀${shownNumber(2 * Math.hypot(gear.base, place), 1, "mm")})` : shownNumber(place, 1, "mm") };
      });
      const [low, high, title] = key === "profile" ? [this.words.root, this.words.tip, `${this.words.roll} (${this.unit("_length")})`] : ["", "", `${this.words.height} (${this.unit("_length")})`];
      const back = (px) => from + ((px - LEFT) / (this.width - LEFT - RIGHT)) * (to - from);
      const amountAt = (py) => lowest + ((py - TOP) / (HIGH - TOP - BOTTOM)) * (scale - lowest);
      const handles = this.handles(key, from, to).map((handle) => ({ ...handle, x: x(handle.place), y: y(handle.amount), value: gear.values[handle.name], told: told(handle.name, gear.values[handle.name]) }));
      return { key, points, up, across, from: low, to: high, title, handles, back, amountAt, scale };
    },
    handles(key, from, to) {
      const values = this.gear.values;
      const length = (name) => values[`${name}_length`] || DEFAULT_LENGTH * (to - from) * (key === "lead" ? 0.5 : 1);
      const relief = (name, end, inwards) => [
        { name, place: end, amount: values[name], rule: (_, amount) => ({ [name]: Math.max(amount, 0), [`${name}_length`]: length(name) }) },
        ...(values[name] ? [{ name: `${name}_length`, across: true, place: end + inwards * length(name), amount: 0, rule: (place) => ({ [name]: values[name], [`${name}_length`]: Math.max(inwards * (place - end), 0.05) }) }] : []),
      ];
      const crowning = (name, share) => ({ name, place: from + share * (to - from), amount: values[name] * (2 * share - 1) ** 2, rule: (_, amount) => ({ [name]: amount / (2 * share - 1) ** 2 }) });
      if (key === "profile") return [...relief("tip_relief", to, -1), ...relief("root_relief", from, 1), crowning("profile_crowning", SHARE)];
      const slope = -this.gear.hand / 2;
      const helix = { name: "helix_angle_modification", place: to, amount: values.helix_angle_modification * slope, rule: (_, amount) => ({ helix_angle_modification: amount / slope }) };
      return [...relief("end_relief", from, 1), crowning("lead_crowning", 1 - SHARE), helix];
    },
    // ---------------------------------------------------------------- by hand
    grab(event, diagram, handle) {
      event.currentTarget.focus();
      event.currentTarget.closest("svg").setPointerCapture(event.pointerId);
      this.step += 1;
      this.held = { diagram, name: handle.name, key: diagram.key };
      this.scales = { profile: this.diagrams[0].scale, lead: this.diagrams[1].scale };
      this.tell(handle, diagram);
    },
    drag(event) {
      if (!this.held) return;
      const box = event.currentTarget.getBoundingClientRect();
      const { diagram, name } = this.held;
      const handle = this.diagram(diagram.key).handles.find((each) => each.name === name);
      if (!handle) return;
      this.send(handle, diagram.back(event.clientX - box.left), diagram.amountAt(event.clientY - box.top));
      this.tell(handle, diagram);
    },
    drop() {
      if (!this.held) return;
      [this.held, this.scales, this.beside] = [null, null, null];
      this.release();
    },
    key(event, handle) {
      const sign = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 }[event.key];
      if (!sign) return;
      event.preventDefault();
      const now = performance.now();
      const goesOn = this.keyed.name === handle.name && now - this.keyed.at <= PAUSE;
      if (!goesOn) this.step += 1;
      const step = (isLength(handle.name) ? 0.1 : 1) * (event.shiftKey ? 10 : 1) * sign;
      this.keyed = { name: handle.name, at: now, value: (goesOn ? this.keyed.value : this.values[handle.name]) + step };
      this.put(handle.name, this.keyed.value, true);
      clearTimeout(this.rested);
      this.rested = setTimeout(this.release, PAUSE / 2);
    },
    type(event, name) {
      const value = stored(Number(event.target.value.trim().replace(",", ".")), isLength(name) ? "mm" : "µm");
      if (!event.target.value.trim() || !Number.isFinite(value)) return (event.target.value = this.number(name, this.values[name]));
      if (this.number(name, value) === this.number(name, this.values[name])) return;
      this.step += 1;
      this.put(name, value, false);
    },
    // A value with what belongs to it: an amount with its length.
    put(name, value, moving) {
      const relief = name.replace("_length", "");
      let values = { [name]: value };
      if (`${relief}_length` in this.values) {
        const span = relief === "end_relief" ? this.gear.width / 2 : this.gear.last - this.gear.first;
        values = { [relief]: this.values[relief], [`${relief}_length`]: this.values[`${relief}_length`] || DEFAULT_LENGTH * span, ...values };
      }
      this.push({ role: this.gear.role, values, step: this.step, moving });
    },
    send(handle, place, amount) {
      const made = this.handles(this.held.key, ...(this.held.key === "profile" ? [this.gear.first, this.gear.last] : [0, this.gear.width]));
      const found = made.find((each) => each.name === handle.name);
      if (found) this.push({ role: this.gear.role, values: found.rule(place, amount), step: this.step, moving: true });
    },
    push(move) {
      this.next = move;
      if (!this.waiting) this.go();
    },
    go() {
      clearTimeout(this.late);
      this.waiting = false;
      if (!this.next) return this.done();
      [this.waiting, this.move, this.next] = [true, this.next, null];
      this.late = setTimeout(this.go, PATIENCE);
      this.$emit("drawn", this.move);
    },
    release() {
      this.releasing = true;
      if (!this.waiting) this.done();
    },
    done() {
      if (!this.releasing || this.held) return;
      this.releasing = false;
      this.$emit("released");
    },
    // The number beside the handle that is held.
    tell(handle, diagram) {
      const { x, y, told: words } = { ...handle, ...this.diagram(diagram.key).handles.find((each) => each.name === handle.name) };
      const anchor = x > this.width / 2 ? "end" : "start";
      this.beside = { key: diagram.key, x: x + (anchor === "end" ? -12 : 12), y: Math.max(y - 10, 14), anchor, words };
    },
  },
};
