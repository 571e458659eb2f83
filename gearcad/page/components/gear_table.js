// Which columns of a table of results are drawn over each other, and the rows that were brushed there.
export default {
  template: `
    <section class="results" :aria-label="words.title">
      <p v-if="line" class="fault" role="alert">{{ line }}</p>
      <p v-if="!name && !line" class="hint">{{ words.hint }}</p>
      <template v-if="name">
        <p class="of">{{ name }}: {{ told }}</p>
        <div class="axes">
          <label v-for="axis in ['x', 'y', 'colour']" :key="axis">{{ words[axis] }}
            <input :value="chosen[axis]" :list="id" spellcheck="false" autocomplete="off" @focus="$event.target.select()"
                   @change.stop="$emit('choose', { ...chosen, [axis]: $event.target.value })" /></label>
        </div>
        <datalist :id="id"><option v-for="column in columns" :key="column" :value="column"></option></datalist>
      </template>
      <table v-if="rows.length">
        <thead><tr><th scope="col">{{ words.design }}</th><th v-for="head in heads" :key="head" scope="col" :title="head">{{ head }}</th></tr></thead>
        <tbody>
          <tr v-for="row in rows" :key="row.number" :class="{ opened: row.number === opened }" @click="$emit('open', { number: row.number })">
            <th scope="row"><button type="button">{{ row.name }}</button></th><td v-for="(cell, at) in row.cells" :key="at">{{ cell }}</td>
          </tr>
        </tbody>
      </table>
    </section>`,
  props: { words: Object },
  emits: ["choose", "open"],
  data() {
    return { name: "", told: "", line: "", columns: [], chosen: {}, heads: [], rows: [], opened: null, id: `columns-${Math.random().toString(36).slice(2)}` };
  },
  methods: {
    show(state) {
      Object.assign(this, state);
    },
  },
};
