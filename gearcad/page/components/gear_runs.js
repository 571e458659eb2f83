// What can be run on the design, how far it is, and the figures of runs beside each other. Nothing is computed here.
import { GearSymbol } from "gear-symbols";

export default {
  components: { GearSymbol },
  template: `
    <section class="runs" :aria-label="words.title">
      <div class="run-kinds">
        <button v-for="kind in kinds" :key="kind.key" type="button" :title="kind.why || kind.told" :disabled="!!kind.why" @click="$emit('start', { kind: kind.key })">
          {{ kind.words }}<small v-if="kind.told">{{ kind.told }}</small><small v-if="kind.why">{{ kind.why }}</small>
        </button>
        <small class="run-limits">{{ limits }}</small>
      </div>
      <p v-if="line" class="fault" role="alert">{{ line }}</p>
      <ol class="run-list">
        <li v-for="run in shown" :key="run.number" :class="[run.state, { stale: stale.includes(run.number) }]">
          <span class="number">{{ run.number + 1 }}</span>
          <span class="what">{{ run.words }}<em v-if="stale.includes(run.number)">{{ words.stale }}</em></span>
          <template v-if="run.state === 'running' || run.state === 'waiting'">
            <progress :value="run.share > 0 ? run.share : null" max="1"></progress>
            <span class="step" role="status">{{ run.state === "waiting" ? words.waiting : [run.step, run.left].filter(Boolean).join(", ") }}</span>
            <button type="button" @click="$emit('cancel', { number: run.number })">{{ words.cancel }}</button>
          </template>
          <template v-else>
            <span class="line">{{ run.line || said(run.state) }}</span>
            <span v-if="run.files" class="links">
              <a v-if="run.report" :href="run.report" target="_blank" rel="noopener noreferrer">{{ words.report }}</a>
              <a :href="run.files" download>{{ words.files }}</a>
            </span>
          </template>
          <small v-for="notice in run.notices" :key="notice" class="notice">{{ notice }}</small>
        </li>
      </ol>
      <div v-for="table in tables" :key="table.verb" class="run-table">
        <label class="only"><input type="checkbox" v-model="differing" /> {{ words.differing }}</label>
        <table>
          <thead><tr>
            <th scope="col">{{ table.words }}</th><th scope="col"></th>
            <th v-for="run in table.runs" :key="run.number" scope="col" :class="{ stale: stale.includes(run.number) }">
              {{ run.number + 1 }}<small v-for="change in run.changes" :key="change">{{ change }}</small>
            </th>
          </tr></thead>
          <tbody>
            <tr v-for="row in rowsOf(table)" :key="row.key" :class="{ differs: row.differs }" :title="row.words + ' (' + row.key + ')'">
              <th scope="row"><i v-if="row.symbol.length"><gear-symbol :parts="row.symbol" /></i>{{ row.words }}</th><td class="unit">{{ row.unit }}</td>
              <td v-for="(cell, at) in row.cells" :key="at">{{ cell }}</td>
            </tr>
          </tbody>
        </table>
      </div>
    </section>`,
  props: { words: Object, limits: String },
  emits: ["start", "cancel"],
  data() {
    return { kinds: [], runs: [], tables: [], stale: [], line: "", differing: false };
  },
  computed: {
    shown() {
      return [...this.runs].reverse();
    },
  },
  methods: {
    show(state) {
      Object.assign(this, state);
    },
    tell(number, told) {
      const run = this.runs.find((each) => each.number === number);
      if (run) Object.assign(run, told);
    },
    said(state) {
      return this.words[state] ?? state;
    },
    rowsOf(table) {
      return this.differing ? table.rows.filter((row) => row.differs) : table.rows;
    },
  },
};
