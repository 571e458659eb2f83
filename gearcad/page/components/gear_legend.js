// Colour bars with their greatest values, over the section or the bodies; those of the bodies have a choice of what is coloured.
import { RAMP } from "gear-colours";

export default {
  template: `
    <div class="gear-legend" v-if="bars.length" role="group" :aria-label="words.title">
      <select v-if="kinds.length" :value="kind" :title="words.title" :aria-label="words.title" @change="choose($event.target.value)">
        <option value="">{{ words.none }}</option><option v-for="each in kinds" :key="each.key" :value="each.key">{{ each.words }}</option>
      </select>
      <span v-for="bar in bars" :key="bar.words" class="bar-of"><span v-if="!kinds.length">{{ bar.words }}</span>
        <span v-if="bar.most" class="scale">0 <i :style="{ background: ramp }"></i> {{ bar.most }}</span></span>
    </div>`,
  props: { words: Object, place: String },
  data() {
    return { bars: [], kinds: [], kind: "", ramp: RAMP };
  },
  mounted() {
    window.addEventListener("gear-legend", this.take);
  },
  beforeUnmount() {
    window.removeEventListener("gear-legend", this.take);
  },
  methods: {
    take({ detail: { place, bars, kinds = [], kind = "" } }) {
      if (place !== this.place) return;
      const state = JSON.stringify([bars, kinds, kind]);
      if (state === this.state) return;
      [this.state, this.bars, this.kinds, this.kind] = [state, bars ?? [], kinds, kind];
    },
    choose(kind) {
      window.dispatchEvent(new CustomEvent("gear-coloured", { detail: { kind } }));
    },
  },
};
