// The sheets of the drawing as pictures, one at a time. A picture runs no scripts, whatever its texts are.
const STEP = 1.25, LEAST = 1, MOST = 8; // of the magnification, where 1 is as wide as the pane

export default {
  template: `
    <section class="gear-drawing" :aria-label="words.title" :aria-busy="waiting" :data-stale="dataStale" @keydown="press">
      <div v-if="sheets.length" class="sheet-tools" role="toolbar" :aria-label="words.title">
        <button v-for="(sheet, at) in sheets" :key="at" type="button" :aria-pressed="at === chosen" :title="sheet.title" @click="choose(at)">{{ sheet.name }}</button>
        <span class="rest"></span><small>{{ sheets[chosen]?.paper }}</small>
        <label v-if="language" class="of-sheets">{{ words.language }} <select :value="language" @change="$emit('language', { code: $event.target.value })"><option v-for="[code, name] in words.languages" :key="code" :value="code">{{ name }}</option></select></label>
        <button type="button" :title="words.smaller" :aria-label="words.smaller" :disabled="zoom <= least" @click="scale(1 / step)">−</button>
        <button type="button" :title="words.larger" :aria-label="words.larger" :disabled="zoom >= most" @click="scale(step)">+</button>
        <button type="button" @click="fit">{{ words.fit }}</button>
        <button type="button" class="pdf" @click="$emit('pdf')">PDF</button>
      </div>
      <p class="waiting" role="status">{{ waiting ? words.waiting : "" }}</p>
      <p v-if="whyNot" class="none">{{ whyNot }}</p>
      <div v-if="sheets.length" ref="paper" class="paper" tabindex="0"><img :src="address" :alt="sheets[chosen]?.title" :style="{ width: zoom * 100 + '%' }" /></div>
      <img v-for="(other, at) in printed" :key="at" class="print-only" :src="other" alt="" />
    </section>`,
  props: { words: Object, dataStale: String },
  emits: ["pdf", "language"],
  data() {
    return { sheets: [], addresses: [], chosen: 0, zoom: LEAST, language: "", whyNot: "", waiting: false, step: STEP, least: LEAST, most: MOST };
  },
  computed: {
    address() {
      return this.addresses[this.chosen];
    },
    // All other sheets, which are seen on paper only.
    printed() {
      return this.addresses.filter((_, at) => at !== this.chosen);
    },
  },
  unmounted() {
    this.release();
  },
  methods: {
    show(sheets, whyNot, language) {
      const former = this.addresses;
      this.addresses = sheets.map(({ svg }) => URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" })));
      this.sheets = sheets.map(({ name, title, paper }) => ({ name, title, paper }));
      this.chosen = Math.min(this.chosen, Math.max(sheets.length - 1, 0));
      [this.whyNot, this.language, this.waiting] = [whyNot, language, false];
      setTimeout(() => former.forEach((each) => URL.revokeObjectURL(each)), 1000);
    },
    wait() {
      this.waiting = true;
    },
    release() {
      this.addresses.forEach((each) => URL.revokeObjectURL(each));
    },
    choose(at) {
      this.chosen = at;
    },
    // The middle of what is seen stays there.
    scale(factor) {
      const paper = this.$refs.paper, former = this.zoom;
      this.zoom = Math.min(Math.max(former * factor, LEAST), MOST);
      const middle = [paper.scrollLeft + paper.clientWidth / 2, paper.scrollTop + paper.clientHeight / 2].map((each) => (each * this.zoom) / former);
      this.$nextTick(() => paper.scrollTo(middle[0] - paper.clientWidth / 2, middle[1] - paper.clientHeight / 2));
    },
    fit() {
      this.zoom = LEAST;
    },
    press(event) {
      if (event.ctrlKey || event.metaKey || event.altKey || !this.sheets.length) return;
      const does = { "+": () => this.scale(STEP), "-": () => this.scale(1 / STEP), 0: () => this.fit() }[event.key];
      if (does) {
        event.preventDefault();
        does();
      }
    },
  },
};
