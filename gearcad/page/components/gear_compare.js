// Designs beside each other: only what differs, the best of each row marked. The first is the edited one.
import { GearSymbol } from "gear-symbols";

const FEW = 2; // designs whose values stand beside the words of a quantity; those of more stand below these

export default {
  components: { GearSymbol },
  template: `
    <section class="compare" :aria-label="words.title" :aria-busy="waiting" :data-stale="dataStale">
      <p v-if="!names.length" class="none">{{ words.hint }}</p>
      <p v-else-if="!rows.length" class="none">{{ words.same }}</p>
      <table v-if="names.length" :class="{ stacked: names.length > few }" :style="{ '--designs': names.length }">
        <thead><tr><th v-if="names.length <= few"></th>
          <th v-for="(name, at) in names" :key="at" scope="col"><span>{{ name }}</span>
            <small>{{ at + 1 }}<template v-if="at === 0"> · {{ words.edited }}</template></small>
            <span v-if="at > 0" class="do"><button type="button" :title="words.swap" :aria-label="words.swap + ': ' + name" @click="$emit('swap', { at: at - 1 })">⇄</button>
              <button type="button" :title="words.go" :aria-label="words.go + ': ' + name" @click="$emit('go', { at: at - 1 })">×</button></span></th></tr></thead>
        <tbody v-for="block in blocks" :key="block.title">
          <tr class="block"><th :colspan="names.length + 1" scope="rowgroup">{{ block.title }}</th></tr>
          <tr v-for="row in block.rows" :key="row.key" :title="[row.source, row.key].filter(Boolean).join(' · ')" :data-compared="row.key">
            <th scope="row"><gear-symbol :parts="row.words" /><template v-if="row.gear"> · {{ row.gear }}</template>
              <i v-if="row.symbol.length"><gear-symbol :parts="row.symbol" /></i> <span class="unit">{{ row.unit }}</span></th>
            <td v-for="(cell, at) in row.cells" :key="at" :class="{ best: cell.best }"><b v-if="cell.best" :title="words.best" :aria-label="words.best" role="img">★</b>{{ cell.text }}</td>
          </tr>
        </tbody>
      </table>
    </section>`,
  props: { words: Object, dataStale: String },
  emits: ["swap", "go"],
  data() {
    return { names: [], rows: [], waiting: false, few: FEW };
  },
  computed: {
    // Rows that follow each other with the same title.
    blocks() {
      const found = [];
      for (const row of this.rows)
        if (found.at(-1)?.title === row.block) found.at(-1).rows.push(row);
        else found.push({ title: row.block, rows: [row] });
      return found;
    },
  },
  methods: {
    show(names, rows) {
      [this.names, this.rows, this.waiting] = [names, Object.freeze(rows), false];
    },
    wait() {
      this.waiting = true;
    },
  },
};
