// How far the first gear is turned. All of it happens here: views hear "gear-turn" on the window, nothing goes to the server.
const PITCHES = 4; // that the slider spans

const fixed = (value, digits) =>
  value.toLocaleString(document.documentElement.lang || "en", { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });

export default {
  template: `
    <div class="gear-roll">
      <button type="button" :disabled="!pitch || still" :aria-pressed="running" :title="running ? words.stop : words.turn" @click="toggle">{{ running ? "❚❚" : "▶" }}</button>
      <input type="range" :disabled="!pitch" :min="-span / 2" :max="span / 2" :step="pitch / 400 || 1" :value="place" :aria-label="words.roll" :aria-valuetext="told()" @input="slide" />
      <output :title="words.roll">{{ told() }}</output>
      <select :title="words.speed" :aria-label="words.speed" v-model.number="speed"><option v-for="each in [0.05, 0.1, 0.25, 0.5, 1, 2]" :value="each">{{ each.toLocaleString(lang()) }}/s</option></select>
    </div>`,
  props: { words: Object },
  data() {
    return { pitch: 0, turn: 0, speed: 0.25, running: false, still: false };
  },
  computed: {
    span() {
      return PITCHES * this.pitch;
    },
    // What runs on past the end of the slider is at its beginning, whole pitches away.
    place() {
      return this.span ? this.turn - this.span * Math.round(this.turn / this.span) : 0;
    },
  },
  mounted() {
    const reduced = window.matchMedia("(prefers-reduced-motion: reduce)");
    this.still = reduced.matches;
    this.listening = new AbortController();
    const { signal } = this.listening;
    reduced.addEventListener("change", () => (this.stop(), (this.still = reduced.matches)), { signal });
    document.addEventListener("visibilitychange", () => document.hidden && this.stop(), { signal });
    window.addEventListener("keydown", this.key, { signal });
  },
  beforeUnmount() {
    this.listening.abort();
    this.stop();
  },
  methods: {
    // The page has its language when there is a pitch.
    told() {
      return `${fixed((this.place * 180) / Math.PI, 2)}°`;
    },
    lang() {
      return document.documentElement.lang || "en";
    },
    show(pitch) {
      this.pitch = pitch;
      if (!pitch) this.stop();
    },
    key(event) {
      const typing = event.target.closest?.("input:not([type=range]), select, textarea, button, summary, a, [contenteditable=true], [role=tab]");
      if (event.code !== "Space" || typing || event.ctrlKey || event.altKey || event.metaKey || !this.pitch || this.still) return;
      event.preventDefault();
      this.toggle();
    },
    toggle() {
      if (this.running) return this.stop();
      this.running = true;
      let last = performance.now();
      const step = (now) => {
        this.to(this.turn + Math.min(now - last, 100) * 1e-3 * this.speed * this.pitch);
        last = now;
        this.frame = requestAnimationFrame(step);
      };
      this.frame = requestAnimationFrame(step);
    },
    stop() {
      cancelAnimationFrame(this.frame);
      this.running = false;
    },
    slide(event) {
      this.stop();
      this.to(Number(event.target.value));
    },
    to(turn) {
      this.turn = turn;
      window.dispatchEvent(new CustomEvent("gear-turn", { detail: { turn } }));
    },
  },
};
