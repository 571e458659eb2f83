// The inputs of a spec: what the schema says of each key makes a field. What is typed is sent as text; what is wrong with it
// comes back as the line that the command line prints, and is shown at its field.
export default {
  template: `
    <form class="inputs" @submit.prevent autocomplete="off">
      <input class="search" type="search" :placeholder="words.search" v-model="wanted" :aria-label="words.search" />
      <details v-for="table in shownTables" :key="table.table" :open="wanted !== '' || !table.folded" class="table">
        <summary>{{ said(table.table) }}</summary>
        <template v-for="group in table.groups" :key="group.part">
          <component :is="group.part && !wanted ? 'details' : 'div'" class="group">
            <summary v-if="group.part && !wanted">{{ said(group.title) }}<b v-if="count(group)">{{ count(group) }}</b></summary>
            <label v-for="field in group.fields" :key="field.key" class="field"
                   :class="{ changed: changed.includes(field.key), wrong: fault && fault.key === field.key, given: field.key in given }"
                   :title="hint(field)" :data-key="field.key">
              <span class="words">{{ said(field.words) }}<i v-if="field.symbol">{{ field.symbol }}</i></span>
              <select v-if="field.choices.length" :value="given[field.key] ?? ''" :disabled="readonly"
                      @change="send(field.key, $event.target.value)">
                <option value="">{{ used[field.key] ?? "" }}</option>
                <option v-for="word in field.choices" :key="word" :value="word">{{ word }}</option>
              </select>
              <input v-else type="text" :inputmode="field.several ? 'text' : 'decimal'" spellcheck="false" :readonly="readonly"
                     :value="typing.key === field.key ? typing.text : given[field.key] ?? ''"
                     :placeholder="used[field.key] ?? ''" :aria-invalid="!!(fault && fault.key === field.key)"
                     @input="type(field.key, $event.target.value)" @blur="leave(field.key)"
                     @keydown.up.prevent="step(field, 1, $event)" @keydown.down.prevent="step(field, -1, $event)" />
              <span class="unit">{{ field.unit }}</span>
              <span v-if="fault && fault.key === field.key" class="fault" role="alert">{{ fault.line }}</span>
            </label>
          </component>
        </template>
      </details>
    </form>`,
  props: { tables: Array, words: Object, terms: Object },
  data() {
    return { wanted: "", typing: { key: null, text: "" }, given: {}, used: {}, changed: [], fault: null, readonly: false };
  },
  computed: {
    shownTables() {
      const wanted = this.wanted.trim().toLowerCase();
      if (!wanted) return this.tables;
      const fits = (field) => `${field.key} ${this.said(field.words)} ${field.symbol}`.toLowerCase().includes(wanted);
      return this.tables
        .map((table) => ({
          ...table,
          groups: table.groups
            .map((group) => ({ ...group, fields: group.fields.filter(fits) }))
            .filter((group) => group.fields.length),
        }))
        .filter((table) => table.groups.length);
    },
  },
  methods: {
    show(state) {
      Object.assign(this, state);
    },
    said(words) {
      return this.terms[words] ?? words;
    },
    count(group) {
      return group.fields.filter((field) => field.key in this.given).length;
    },
    hint(field) {
      const lines = [field.key];
      if (field.least !== null || field.most !== null) lines.push(`${field.least ?? "-∞"} … ${field.most ?? "∞"} ${field.unit}`);
      if (field.special.length) lines.push(field.special.join(", "));
      if (field.source) lines.push(field.source);
      return lines.join("\n");
    },
    type(key, text) {
      this.typing = { key, text };
      this.send(key, text);
    },
    leave(key) {
      if (this.typing.key === key) this.typing = { key: null, text: "" };
    },
    step(field, sign, event) {
      const text = event.target.value || event.target.placeholder;
      const value = Number(text.replace(",", "."));
      if (field.several || text.trim() === "" || Number.isNaN(value) || this.readonly) return;
      const digits = field.whole ? 0 : Math.max((text.split(/[.,]/)[1] ?? "").length, 1);
      const size = (field.whole ? 1 : 10 ** -digits) * (event.shiftKey ? 10 : 1);
      this.type(field.key, (value + sign * size).toFixed(digits));
    },
    send(key, text) {
      this.$emit("change", { key, text });
    },
  },
};
