// What a check or the dynamics found: curves over the roll slider, the pattern of contact, K_v over speed. Charts are loaded when
// there is one to show. Colours are drawn into the section when it paints, and bodies get theirs by a message.
import { fixed, shown } from "gear-units";
import { HEXES, paintSection, rollAngle } from "gear-colours";

const NARROW = 440; // pixels below which grids that stand side by side stand one over the other


export default {
  template: `
    <section class="gear-results" :aria-label="words.title" :hidden="!choices.length">
      <div class="results-bar" v-if="choices.length">
        <button type="button" class="fold" :aria-expanded="open" :title="words.title" @click="fold">{{ open ? "▾" : "▸" }} {{ words.title }}</button>
        <template v-if="open">
          <select v-if="choices.length > 1" :value="chosen" :title="words.choose" :aria-label="words.choose" @change="$emit('choose', { number: Number($event.target.value) })">
            <option v-for="each in choices" :key="each.number" :value="each.number">{{ each.words }}{{ each.stale ? ": " + words.stale : "" }}</option>
          </select>
          <span v-else class="of">{{ choices[0].words }}</span>
          <button v-for="view in views" :key="view.key" type="button" :aria-pressed="view.key === viewed" @click="viewed = view.key">{{ view.words }}</button>
        </template>
      </div>
      <div v-show="open && choices.length" class="results-body">
        <p class="stale-band" v-if="stale" role="status">{{ words.stale }}</p>
        <p class="told">{{ told }}</p>
        <p class="now" v-if="now.length" aria-live="off"><span v-for="each in now" :key="each">{{ each }}</span></p>
        <div class="results-chart" :style="{ height: height + 'px' }">
          <div ref="chart" role="img" :aria-label="label"></div>
          <i ref="marker" class="marker" hidden></i>
        </div>
      </div>
    </section>`,
  props: { words: Object },
  emits: ["choose"],
  data() {
    return { choices: [], chosen: -1, stale: false, views: [], viewed: "", result: null, open: true, now: [], narrow: false };
  },
  computed: {
    view() {
      return this.views.find(({ key }) => key === this.viewed);
    },
    told() {
      return this.view?.told ?? "";
    },
    height() {
      return (this.narrow && this.view?.narrow?.height) || (this.view?.height ?? 180);
    },
    label() {
      return this.view ? `${this.view.words}. ${this.view.told}` : "";
    },
  },
  watch: { viewed: "chart", open: "chart" },
  mounted() {
    this.observers = [new ResizeObserver(this.resize), new MutationObserver(() => this.chart())];
    this.observers[0].observe(this.$refs.chart);
    this.observers[1].observe(document.body, { attributeFilter: ["class"] });
    window.addEventListener("gear-section", this.paint);
  },
  beforeUnmount() {
    for (const observer of this.observers) observer.disconnect();
    window.removeEventListener("gear-section", this.paint);
    this.drawn?.dispose();
  },
  methods: {
    // What can be chosen and which of it is of earlier inputs; views and the result itself only where they are others.
    show(state) {
      for (const key of ["choices", "chosen", "stale"]) if (key in state) this[key] = state[key];
      if ("views" in state) {
        this.views = Object.freeze(state.views);
        this.result = state.result && Object.freeze(state.result);
        if (!this.view) this.viewed = this.views[0]?.key ?? "";
        this.$nextTick(this.chart);
      }
      this.$el.dataset.chosen = this.chosen;
      this.mark();
      window.dispatchEvent(new Event("gear-redraw"));
    },
    resize() {
      const narrow = this.$refs.chart.clientWidth < NARROW;
      if (narrow !== this.narrow) [this.narrow] = [narrow, this.chart()];
      this.drawn?.resize();
      this.mark();
    },
    fold() {
      this.open = !this.open;
    },
    // ---------------------------------------------------------------- charts
    async chart() {
      if (!this.open || !this.view) return this.mark();
      const { echarts } = await import("nicegui-echart");
      if (!this.$refs.chart || !this.view) return;
      this.narrow = this.$refs.chart.clientWidth < NARROW;
      await this.$nextTick();
      this.drawn ??= echarts.init(this.$refs.chart, null, { renderer: "canvas" });
      this.drawn.resize();
      const style = getComputedStyle(document.body);
      const text = JSON.stringify({ ...this.view.option, ...(this.narrow ? this.view.narrow?.option : {}) }).replace(/var\((--\w+)\)/g, (_, name) => style.getPropertyValue(name).trim());
      const option = JSON.parse(text);
      if (option.visualMap) option.visualMap.inRange = { color: HEXES };
      const digits = (value) => Number(value.toPrecision(5)).toLocaleString(document.documentElement.lang || "en", { maximumFractionDigits: 6, useGrouping: false });
      for (const axis of [option.xAxis, option.yAxis].flat()) if (axis.type === "value") axis.axisLabel = { ...axis.axisLabel, formatter: digits };
      if (option.tooltip) option.tooltip.valueFormatter = (value) => (typeof value === "number" ? digits(value) : value);
      this.drawn.setOption(option, true);
      this.$el.dataset.drawn = `${this.chosen} ${this.viewed}`;
      this.mark();
    },
    // The line at the roll angle of the slider, and the values there.
    mark(angle = this.angle) {
      this.angle = angle;
      const { marker } = this.$refs;
      const curves = this.view?.curves;
      if (!marker || !this.drawn || !this.open || !curves || angle === undefined || this.stale) {
        if (marker) marker.hidden = true;
        this.now = [];
        return;
      }
      const x = this.drawn.convertToPixel({ xAxisIndex: 0 }, angle);
      marker.hidden = !Number.isFinite(x);
      marker.style.left = `${x}px`;
      const { roll_angle: angles } = this.result.curves;
      const values = curves.map(({ words, unit, course, digits }) => `${words} ${fixed(nearest(angles, course, angle), digits)} ${unit}`);
      this.now = [`${fixed(angle, 2)}°`, ...values];
    },
    // ---------------------------------------------------------------- colours in the section
    paint({ detail: { section, pen } }) {
      if (!this.result?.contacts || this.stale || !section.content?.meshes.length) return this.legend(null);
      const { pressure, root } = this.result.limits;
      paintSection(section, pen, this.result, this.result.limits, (value) => shown(value, 0, "MPa"), fixed);
      this.legend([
        { words: this.words.pressure, most: shown(pressure, 0, "MPa") },
        { words: this.words.root, most: shown(root, 0, "MPa") },
      ]);
      this.mark(rollAngle(section, this.result));
    },
    legend(bars) {
      window.dispatchEvent(new CustomEvent("gear-legend", { detail: { place: "section", bars } }));
    },
  },
};

// The value of a course over one base pitch, on a straight line between positions; the course goes on as it began.
function nearest(angles, course, angle) {
  const count = angles.length;
  if (count < 2) return course[0];
  const step = angles[1] - angles[0];
  const place = (((angle - angles[0]) / step) % count + count) % count;
  const [low, high] = [Math.floor(place) % count, (Math.floor(place) + 1) % count];
  return course[low] + (course[high] - course[low]) * (place - Math.floor(place));
}
