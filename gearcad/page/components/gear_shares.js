// How the planets of a train share its load: a bar for each, from least to greatest a line, at 1 what all would carry alike.
const fixed = (value, digits) =>
  value.toLocaleString(document.documentElement.lang || "en", { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });

export default {
  template: `
    <div class="gear-shares" v-if="content" :aria-busy="busy">
      <h2>{{ words.title }} <small v-if="content.factor">{{ words.factor }} <i>K_γ</i> {{ fixed(content.factor, 4) }}</small></h2>
      <p v-if="!content.shares.length">{{ content.why_not }}</p>
      <div v-for="([least, share, greatest], n) in content.shares" class="share">
        <span>{{ words.planet }} {{ n + 1 }}</span>
        <svg viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden="true">
          <rect y="2" height="6" :width="at(share)" />
          <line :x1="at(least)" :x2="at(greatest)" y1="5" y2="5" class="range" />
          <line :x1="at(1)" :x2="at(1)" y1="0" y2="10" class="even" />
        </svg>
        <b>{{ fixed(share, 3) }}</b><small>{{ greatest - least > 5e-4 ? fixed(least, 3) + " … " + fixed(greatest, 3) : "" }}</small>
      </div>
    </div>`,
  props: { words: Object },
  data() {
    return { content: null, busy: false };
  },
  methods: {
    fixed,
    show(content) {
      [this.content, this.busy] = [content, false];
    },
    wait() {
      this.busy = true;
    },
    at(share) {
      return (100 * share) / Math.max(1.05, ...this.content.shares.map(([, , greatest]) => greatest));
    },
  },
};
