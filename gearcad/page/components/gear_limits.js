// A shift diagram: fields over a grid, drawn as lines of equal values and as regions. All values come from the server; between
// them the browser interpolates. What is moved goes to the server, one move at a time.
const PATIENCE = 3000; // ms until a move that nobody answers is taken for lost
const FINE = 4; // pixels of the regions to one of the grid
const LEFT = 36, TOP = 6, WIDE = 272, HIGH = 240;

const fixed = (value, digits) =>
  value.toLocaleString(document.documentElement.lang || "en", { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });

export default {
  template: `
    <div class="limits">
      <p v-if="!variables.length" class="none">{{ words.none }}</p>
      <template v-else>
        <svg :viewBox="'0 0 ' + (LEFT + WIDE + 6) + ' ' + (TOP + HIGH + 34)" tabindex="0" role="application" :aria-label="words.map + '. ' + said"
             @pointerdown="grab" @pointermove="drag" @pointerup="grabbed = false" @pointercancel="grabbed = false" @keydown="press">
          <foreignObject :x="LEFT" :y="TOP" :width="WIDE" :height="HIGH"><canvas ref="regions" class="regions"></canvas></foreignObject>
          <g class="ticks">
            <template v-for="tick in ticks(variables[0])"><line :x1="across(tick)" :x2="across(tick)" :y1="TOP" :y2="TOP + HIGH" :class="{ zero: tick === 0 }" />
              <text :x="across(tick)" :y="TOP + HIGH + 14" text-anchor="middle">{{ decimal(tick) }}</text></template>
            <template v-for="tick in ticks(variables[1])"><line :x1="LEFT" :x2="LEFT + WIDE" :y1="up(tick)" :y2="up(tick)" :class="{ zero: tick === 0 }" />
              <text :x="LEFT - 4" :y="up(tick) + 4" text-anchor="end">{{ decimal(tick) }}</text></template>
            <text :x="LEFT + WIDE / 2" :y="TOP + HIGH + 29" text-anchor="middle" class="axis">{{ axis(variables[0]) }}</text>
            <text :x="4" :y="TOP + 9" class="axis">{{ axis(variables[1]) }}</text>
          </g>
          <g v-for="line in lines" :key="line.key" :class="['limit', line.kind, line.role, 'at' + line.order]">
            <path :d="line.d" /><text v-if="line.label" :x="line.x" :y="line.y">{{ line.label }}</text>
          </g>
          <g class="here"><line :x1="across(at[0])" :x2="across(at[0])" :y1="TOP" :y2="TOP + HIGH" /><line :x1="LEFT" :x2="LEFT + WIDE" :y1="up(at[1])" :y2="up(at[1])" />
            <circle :cx="across(at[0])" :cy="up(at[1])" r="4.5" /></g>
        </svg>
        <label v-for="(variable, place) in variables" :key="place" class="slide"><span>{{ variable.words }}</span><i>{{ variable.symbol }}</i>
          <input type="range" :min="variable.least" :max="variable.most" :step="variable.step" :value="at[place]" :disabled="readonly"
                 @input="move({ [place]: Number($event.target.value) })" /><output>{{ shown(variable, at[place]) }}</output></label>
        <ul class="legend">
          <li v-for="limit in drawn" :key="limit.kind + limit.role" :class="['limit', limit.kind, limit.role]">
            <svg viewBox="0 0 22 8"><path d="M0 4H22" /></svg><span>{{ limit.words }}</span><output>{{ here(limit) }}</output></li>
          <li><b class="refused"></b><span>{{ words.refused }}</span></li><li><b class="warned"></b><span>{{ words.warned }}</span></li>
        </ul>
      </template>
    </div>`,
  props: { words: Object },
  emits: ["moved"],
  data() {
    return { LEFT, TOP, WIDE, HIGH, variables: [], limits: [], lines: [], at: [], grabbed: false, readonly: false };
  },
  computed: {
    drawn() {
      return this.limits.filter((limit) => this.lines.some((line) => line.kind === limit.kind && line.role === limit.role));
    },
    said() {
      return this.variables.map((variable, place) => `${variable.words} ${this.shown(variable, this.at[place])}`).join(", ");
    },
  },
  created() {
    this.waiting = null; // a move that is on its way
    this.queue = null;
  },
  mounted() {
    this.dark = new MutationObserver(() => this.paint());
    this.dark.observe(document.body, { attributeFilter: ["class"] });
    this.readonly = window.matchMedia("(max-width: 640px)").matches;
  },
  unmounted() {
    this.dark.disconnect();
    clearTimeout(this.waiting);
  },
  methods: {
    show({ variables, limits }) {
      this.variables = variables;
      if (limits) this.limits = Object.freeze(limits);
      this.answered();
      if (!this.waiting && !this.grabbed) this.at = variables.map((variable) => variable.value);
      if (limits && variables.length) {
        this.lines = this.limits.flatMap((limit) => limit.lines.map((level, order) => this.line(limit, level, order))).filter((line) => line.d);
        this.$nextTick(this.paint);
      }
    },
    shown(variable, value) {
      return fixed(value, Math.max(0, Math.round(-Math.log10(variable.step)))) + variable.unit;
    },
    axis({ symbol, unit }) {
      return unit ? `${symbol} (${unit})` : symbol;
    },
    decimal(tick) {
      return tick.toLocaleString(document.documentElement.lang || "en", { useGrouping: false });
    },
    across(value) {
      const { least, most } = this.variables[0];
      return LEFT + ((value - least) / (most - least)) * WIDE;
    },
    up(value) {
      const { least, most } = this.variables[1];
      return TOP + HIGH - ((value - least) / (most - least)) * HIGH;
    },
    ticks({ least, most }) {
      const wide = (most - least) / 5;
      const ten = 10 ** Math.floor(Math.log10(wide));
      const step = ten * [1, 2, 5, 10].find((factor) => factor * ten >= wide);
      const made = [];
      for (let n = Math.ceil(least / step - 1e-9); n * step <= most + 1e-9; n++) made.push(Number((n * step).toFixed(6)));
      return made;
    },
    // The value of a field at a place of its grid, counted in columns and rows; null where there is none.
    field({ values }, column, row) {
      const i = Math.min(Math.max(Math.floor(column), 0), values[0].length - 2), j = Math.min(Math.max(Math.floor(row), 0), values.length - 2);
      const u = column - i, v = row - j;
      const corners = [values[j][i], values[j][i + 1], values[j + 1][i], values[j + 1][i + 1]];
      if (corners.includes(null)) return values[Math.round(j + v)]?.[Math.round(i + u)] ?? null;
      return (corners[0] * (1 - u) + corners[1] * u) * (1 - v) + (corners[2] * (1 - u) + corners[3] * u) * v;
    },
    here(limit) {
      const [x, y] = this.variables;
      const share = (variable, value) => (value - variable.least) / (variable.most - variable.least);
      const value = this.field(limit, share(x, this.at[0]) * (limit.values[0].length - 1), share(y, this.at[1]) * (limit.values.length - 1));
      return value === null ? "–" : `${fixed(value, 2)} ${limit.unit}`.trim();
    },
    // Marching squares: the pieces of a line of equal values, cell by cell, joined where they meet.
    line(limit, level, order) {
      const { values } = limit, columns = values[0].length, rows = values.length, pieces = [];
      const cross = (a, b) => (a < level !== b < level ? (level - a) / (b - a) : null);
      for (let j = 0; j + 1 < rows; j++)
        for (let i = 0; i + 1 < columns; i++) {
          const [a, b, c, d] = [values[j][i], values[j][i + 1], values[j + 1][i + 1], values[j + 1][i]];
          if (a === null || b === null || c === null || d === null) continue;
          const found = [[cross(a, b), (t) => [i + t, j]], [cross(b, c), (t) => [i + 1, j + t]], [cross(d, c), (t) => [i + t, j + 1]], [cross(a, d), (t) => [i, j + t]]]
            .filter(([t]) => t !== null).map(([t, place]) => place(t));
          for (let n = 0; n + 1 < found.length; n += 2) pieces.push([found[n], found[n + 1]]);
        }
      const place = ([i, j]) => [LEFT + (i / (columns - 1)) * WIDE, TOP + HIGH - (j / (rows - 1)) * HIGH];
      const d = this.chained(pieces).map((chain) => "M" + chain.map((end) => place(end).map((each) => each.toFixed(1)).join(" ")).join("L")).join("");
      const [x, y] = pieces.length ? place(pieces[Math.floor(pieces.length * 0.4)][0]) : [0, 0];
      const label = limit.lines.length > 1 ? fixed(level, 1) : "";
      return { key: `${limit.kind} ${limit.role} ${level}`, kind: limit.kind, role: limit.role, order, d, x: x + 2, y: y - 2, label };
    },
    // Pieces that have ends in common become one line, so that it can be dashed.
    chained(pieces) {
      const named = (end) => end.map((each) => each.toFixed(6)).join();
      const at = new Map();
      for (const piece of pieces) for (const end of piece) at.set(named(end), [...(at.get(named(end)) ?? []), piece]);
      const left = new Set(pieces), chains = [];
      const grow = (chain) => {
        for (;;) {
          const end = chain[chain.length - 1];
          const piece = at.get(named(end)).find((each) => left.has(each));
          if (!piece) return chain;
          left.delete(piece);
          chain.push(named(piece[0]) === named(end) ? piece[1] : piece[0]);
        }
      };
      for (const piece of pieces)
        if (left.delete(piece)) chains.push(grow(grow([...piece]).reverse()));
      return chains;
    },
    paint() {
      const canvas = this.$refs.regions;
      if (!canvas || !this.limits.length) return;
      const columns = this.limits[0].values[0].length, rows = this.limits[0].values.length;
      canvas.width = (columns - 1) * FINE;
      canvas.height = (rows - 1) * FINE;
      const context = canvas.getContext("2d"), image = context.createImageData(canvas.width, canvas.height);
      const dark = document.body.classList.contains("body--dark");
      const refused = dark ? [255, 138, 128, 70] : [179, 38, 30, 60], warned = dark ? [255, 200, 60, 45] : [230, 170, 0, 45];
      for (let y = 0; y < canvas.height; y++)
        for (let x = 0; x < canvas.width; x++) {
          let colour = null;
          for (const limit of this.limits) {
            const value = this.field(limit, (x + 0.5) / FINE, rows - 1 - (y + 0.5) / FINE);
            if (limit.refused !== null && (value === null || value <= limit.refused)) { colour = refused; break; }
            if (value !== null && value < limit.warned) colour = warned;
          }
          if (colour) image.data.set(colour, (y * canvas.width + x) * 4);
        }
      context.putImageData(image, 0, 0);
    },
    grab(event) {
      if (this.readonly) return;
      this.grabbed = true;
      event.currentTarget.setPointerCapture(event.pointerId);
      this.drag(event);
    },
    drag(event) {
      if (!this.grabbed) return;
      const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(event.currentTarget.getScreenCTM().inverse());
      const [x, y] = this.variables;
      this.move({ 0: this.near(x, x.least + ((place.x - LEFT) / WIDE) * (x.most - x.least)), 1: this.near(y, y.least + ((TOP + HIGH - place.y) / HIGH) * (y.most - y.least)) });
    },
    press(event) {
      const [place, sign] = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1] }[event.key] ?? [];
      if (place === undefined || this.readonly) return;
      event.preventDefault();
      this.move({ [place]: this.near(this.variables[place], this.at[place] + sign * this.variables[place].step * (event.shiftKey ? 10 : 1)) });
    },
    near({ least, most, step }, value) {
      return Number((Math.round(Math.min(Math.max(value, least), most) / step) * step).toFixed(6));
    },
    move(values) {
      for (const [place, value] of Object.entries(values)) this.at[place] = value;
      this.queue = { ...this.queue, ...values };
      if (!this.waiting) this.flush();
    },
    flush() {
      if (!this.queue) return;
      const values = this.queue;
      this.queue = null;
      this.waiting = setTimeout(() => this.answered(), PATIENCE);
      this.$emit("moved", values);
    },
    answered() {
      clearTimeout(this.waiting);
      this.waiting = null;
      this.flush();
    },
  },
};
