// The inputs of a spec: what the schema says of each key makes a field. What is typed is sent as text; what is wrong with it
// comes back as the line that the command line prints, and is shown at its field. One change is on its way at a time: what is
// typed meanwhile waits, so that no server lags behind a key that is held down.
import { toRaw } from "vue";
import { Changes, PAUSE, keepUnheard, takeUnheard } from "gear-changes";
import { GearSymbol } from "gear-symbols";

const decimal = (text) => (document.documentElement.lang === "de" ? text.replaceAll(".", ",") : text);
const LIST = /^-?\d+([.]\d+)?([ :]-?\d+([.]\d+)?)+$/; // of numbers, or of lists of them

const LONG = 18; // letters of a text that stands under its words

const MOST = 3; // columns of gears beside each other

const PHONE = "(max-width: 640px)";

// One field. Its part of the page stays as it is while all that it is given does.
const SpecField = {
  template: `
    <div :data-key="field.key" class="field" :class="{ changed, wrong: !!fault, given: given !== undefined, cell, long: isLong, follows: why && !isNumber }">
      <label v-if="!cell" :for="'in-' + field.key" :title="[field.words, field.source].filter(Boolean).join(' · ')"><span>{{ field.words }}</span><i v-if="field.symbol"><gear-symbol :parts="field.parts" /></i></label>
      <span class="box" :title="why || null" :data-gear="gear || null" :style="cell ? { gridColumn: 'span ' + cell } : null">
        <select v-if="field.choices.length" :id="'in-' + field.key" :value="draft ?? given ?? ''" :disabled="readonly" :aria-label="name"
                :aria-invalid="!!fault" @focus="form.focused = field" @change="form.type(field.key, $event.target.value)" @blur="form.leave(field.key)" @keydown="form.choose($event)">
          <option value="">{{ used ?? "" }}</option>
          <option v-if="given && !field.choices.includes(given)">{{ given }}</option>
          <option v-for="word in field.choices" :key="word" :value="word">{{ word }}</option>
        </select>
        <input v-else :id="'in-' + field.key" type="text" spellcheck="false" :class="{ words: !field.number && !cell }" :aria-label="name"
               :readonly="readonly" :value="draft ?? shown(given ?? '')" :placeholder="shown(used ?? '')"
               :list="field.offered.length ? 'of-' + field.key : null" :aria-invalid="!!fault"
               @focus="form.focused = field" @input="form.type(field.key, $event.target.value)" @blur="form.leave(field.key)"
               @keydown="form.press(field, $event)" />
        <button v-if="given !== undefined && !readonly" type="button" class="out" tabindex="-1" :title="form.words.out"
                :aria-label="form.words.out + ': ' + field.words" @click="form.out(field.key)">×</button>
        <small v-if="field.number && given !== undefined && !isNumber && used && used !== given" class="used">{{ shown(used) }}</small>
        <small v-if="beside" class="used pitch"><gear-symbol :parts="beside" /></small>
      </span>
      <span v-if="!cell" class="unit">{{ field.unit }}</span>
      <datalist v-if="field.offered.length" :id="'of-' + field.key"><option v-for="word in field.offered" :key="word" :value="word" /></datalist>
      <span v-if="fault" class="fault" role="alert">{{ fault }}</span>
    </div>`,
  components: { GearSymbol },
  // A cell stands in a row of its own quantity, over so many columns; why it follows from other inputs, if it does.
  props: { form: Object, field: Object, given: null, used: null, draft: null, changed: Boolean, fault: String, readonly: Boolean, cell: Number, gear: String, why: String, beside: Array },
  computed: {
    isNumber() {
      return this.given !== undefined && !Number.isNaN(Number(this.given));
    },
    // A long text stands under its words.
    isLong() {
      return !this.cell && !this.field.number && !this.field.choices.length && (this.given ?? "").length > LONG;
    },
    name() {
      return this.cell ? [this.field.words, this.gear].filter(Boolean).join(", ") : null;
    },
  },
  methods: {
    // Numbers have the decimal sign of the page, and may be typed with either.
    shown(text) {
      return this.field.number || LIST.test(text) ? decimal(text) : text;
    },
  },
};

export default {
  components: { GearSymbol, SpecField },
  template: `
    <form class="inputs" :data-stale="dataStale" @submit.prevent autocomplete="off" :aria-label="words.inputs">
      <div class="find" ref="find">
        <input class="search" type="search" ref="search" v-model="wanted" :placeholder="words.search + '  /'" :aria-label="words.search"
               @keydown.esc="wanted = ''; $event.target.blur()" @keydown.enter.prevent="next($event)" />
        <p v-if="faults.length" class="faults" role="status">{{ faults.length }} {{ faults.length === 1 ? words.fault : words.faults }}</p>
        <small v-if="dataStale && faults.length" class="of"> · {{ dataStale }}</small>
        <button v-if="faultAbove" type="button" class="fault" role="alert" @click="go(fault.key)">{{ fault.line }}</button>
      </div>
      <section v-if="firstRows.length" class="ranked" :class="{ many: ranked.columns.length > 2, captioned: ranked.columns.length > MOST }" :style="{ '--gears': columns }" :aria-label="words.first">
        <div v-if="ranked.columns.length > 1 && ranked.columns.length <= MOST" class="row head"><span class="name" /><span v-for="title in ranked.columns" :key="title" class="gear">{{ title }}</span><span class="unit" /></div>
        <div v-for="row in firstRows" :key="row.keys.join()" class="row" :class="[row.shared ? 'shared' : 'own', { text: !row.first.number }]">
          <span class="name" :title="[row.first.words, row.first.source].filter(Boolean).join(' · ')"><span>{{ row.first.words }}</span><i v-if="row.first.symbol"><gear-symbol :parts="row.first.parts" /></i></span>
          <template v-for="(field, at) in row.fields" :key="at">
            <spec-field v-if="field" :form="me" :field="field" :given="given[field.key]" :used="used[field.key]" :cell="row.shared ? columns : 1"
                        :gear="row.shared ? '' : ranked.columns[at]" :draft="drafts[field.key]" :changed="isChanged(field)" :fault="faultAt(field.key)?.line ?? ''"
                        :readonly="readonly" :why="why[field.key] ?? ''" :beside="beside[field.key]" />
            <span v-else class="box" />
          </template>
          <span class="unit">{{ row.first.unit }}</span>
        </div>
        <div v-if="holds.length" class="row"><div class="holds" role="group" :aria-label="words.hold"><span>{{ words.hold }}</span>
          <button v-for="hold in holds" :key="hold.what" type="button" :aria-pressed="hold.on" :title="hold.title" :aria-label="hold.title" :disabled="readonly" @click="pressHold(hold.what)"><i>{{ hold.what }}</i></button>
          <small role="status">{{ note.join(" ") }}</small></div></div>
      </section>
      <p v-if="!shownTables.length" class="none">{{ words.nothing }}</p>
      <p v-else-if="tables[0].table === 'train'" class="none">{{ words.textOnly }}</p>
      <details v-for="table in shownTables" :key="table.table" :open="wanted !== '' || !(table.folded || firstRows.length)" class="table">
        <summary>{{ table.title }}<b v-if="count(table)">{{ count(table) }}</b></summary>
        <component v-for="family in families(table)" :key="family.part" :is="family.title && !wanted ? 'details' : 'div'" class="family">
        <summary v-if="family.title && !wanted" :class="{ changed: family.groups.some((group) => group.fields.some(isChanged)) }">{{ family.title }}<b v-if="count(family)">{{ count(family) }}</b></summary>
        <component v-for="group in family.groups" :key="group.part" :is="group.title && !wanted ? 'details' : 'div'" class="group">
          <summary v-if="group.title && !wanted" :class="{ changed: group.fields.some(isChanged) }">{{ group.title }}<b v-if="countIn(group)">{{ countIn(group) }}</b></summary>
          <spec-field v-for="field in group.fields" :key="field.key" :form="me" :field="field" :given="given[field.key]" :used="used[field.key]"
                      :draft="drafts[field.key]" :changed="isChanged(field)" :fault="faultAt(field.key)?.line ?? ''" :readonly="readonly" />
        </component>
        </component>
      </details>
      <div class="hint" ref="hint" role="status">{{ hint }}</div>
    </form>`,
  props: { tables: Array, words: Object, dataStale: String },
  emits: ["typed", "step", "hold"],
  data() {
    return { MOST, ranked: { columns: [], rows: [] }, holds: [], note: [], why: {}, beside: {}, wanted: "", drafts: {}, given: {}, used: {}, changed: [], faults: [], focused: null, readonly: false };
  },
  computed: {
    me() {
      return this;
    },
    // Without Vue's watch over everything in them: they change as a whole.
    ownTables() {
      return toRaw(this.tables);
    },
    keys() {
      return new Set(this.ownTables.flatMap((table) => table.groups.flatMap((group) => group.fields.map((field) => field.key))));
    },
    columns() {
      const gears = Math.max(this.ranked.columns.length, 1);
      return gears > MOST ? 2 : gears;
    },
    // The inputs that matter most, which stand first unless one searches.
    firstRows() {
      if (this.wanted.trim()) return [];
      const fields = new Map(this.ownTables.flatMap((table) => table.groups.flatMap((group) => group.fields.map((field) => [field.key, field]))));
      const rows = this.ranked.rows.map(({ keys, shared }) => ({ keys, shared, fields: keys.map((key) => fields.get(key)) }));
      return rows.map((row) => ({ ...row, first: row.fields.find(Boolean) })).filter((row) => row.first);
    },
    // All others in their tables, or what is found.
    shownTables() {
      const parts = this.wanted.trim().toLowerCase().split(/\s+/);
      const first = new Set(this.firstRows.flatMap((row) => row.keys));
      const fits = (table, group) => (field) => {
        if (first.has(field.key)) return false;
        const said = `${field.key} ${field.words} ${field.symbol} ${field.symbol.replaceAll("_", "")} ${table.title} ${group.family} ${group.title}`.replaceAll("\u00ad", "").toLowerCase();
        return parts.every((part) => said.includes(part));
      };
      return this.ownTables
        .map((table) => ({
          ...table,
          groups: table.groups
            .map((group) => ({ ...group, fields: group.fields.filter(fits(table, group)) }))
            .filter((group) => group.fields.length),
        }))
        .filter((table) => table.groups.length);
    },
    // The fault that the command line tells.
    fault() {
      return this.faults[0] ?? null;
    },
    // A fault that no field can show, or whose field is not the one that is being typed into.
    faultAbove() {
      return this.fault && !(this.keys.has(this.fault.key) && this.focused?.key === this.fault.key);
    },
    hint() {
      const field = this.focused;
      if (!field) return "";
      const said = this.why[field.key] ? [field.key, this.why[field.key]] : [field.key];
      if (field.least !== null || field.most !== null)
        said.push(this.range(field));
      if (field.offered.length && field.offered.length < 8) said.push(field.offered.join(", "));
      if (field.source) said.push(field.source);
      const shared = `pair.${field.key.slice(field.key.indexOf(".") + 1)}`;
      if (!(field.key in this.given) && field.key !== shared && shared in this.given) said.push(`${this.words.shared} ${shared}`);
      return said.join(" · ");
    },
  },
  created() {
    this.changes = new Changes((change) => this.$emit("forth" in change ? "step" : "typed", change));
    this.queue = []; // changes that wait
    this.typing = { key: "", at: 0, step: 0 };
    this.left = new Set(); // keys of fields that were left before their change was answered
    this.later = []; // arrow keys that wait until the step before them is undone
  },
  mounted() {
    this.phone = window.matchMedia(PHONE);
    this.turned = () => (this.readonly = this.phone.matches);
    this.phone.addEventListener("change", this.turned);
    this.turned();
    window.addEventListener("keydown", this.shortcut);
    window.addEventListener("gear-focus", this.led);
    window.addEventListener("gear-flush", this.flushed);
    window.addEventListener("pagehide", this.keep);
    this.unheard = takeUnheard("inputs");
  },
  unmounted() {
    this.phone.removeEventListener("change", this.turned);
    window.removeEventListener("keydown", this.shortcut);
    window.removeEventListener("gear-focus", this.led);
    window.removeEventListener("gear-flush", this.flushed);
    window.removeEventListener("pagehide", this.keep);
    this.changes.end();
  },
  methods: {
    show({ reveal, heard, ...state }) {
      const former = this.faults.map((fault) => fault.line).join();
      for (const each of Object.values(state)) Object.freeze(each); // so that Vue does not watch everything in it
      Object.assign(this, state);
      this.hear(heard);
      const unheard = this.unheard ?? [];
      this.unheard = null;
      for (const { key, text } of unheard) this.type(key, text);
      for (const key of Object.keys(this.drafts))
        if (!this.pending(key) && (reveal || (this.left.has(key) && this.focused?.key !== key))) this.forget(key, reveal);
      if (!this.undoing()) for (const step of this.later.splice(0)) step();
      const wrong = this.faults.map((fault) => fault.line).join() !== former && (this.faultAt(this.focused?.key) ?? this.fault);
      const key = (wrong && wrong.key) || (reveal ? this.changed[0] : null);
      if (key) this.$nextTick(() => this.reveal(key, !this.focused || this.focused.key === key));
    },
    isChanged(field) {
      return this.changed.includes(field.key);
    },
    faultAt(key) {
      return this.faults.find((fault) => fault.key === key);
    },
    countIn(group) {
      return group.fields.filter((field) => field.key in this.given).length;
    },
    // Groups of a part and of its own parts stand together.
    families({ groups: all }) {
      const found = [];
      const begun = new Set(all.filter((group) => this.countIn(group)).map((group) => group.family));
      const groups = all.filter((group) => !group.inner || this.wanted || begun.has(group.family)); // parts of what is not there are found by search
      for (const group of groups)
        if (group.family && found.at(-1)?.title === group.family) found.at(-1).groups.push(group);
        else found.push({ part: group.part, title: group.family, groups: [group] });
      return found;
    },
    count(table) {
      return table.groups.reduce((sum, group) => sum + this.countIn(group), 0);
    },
    // The permitted range, such as "3 … 2000 or −2000 … −3".
    range({ least, most, negative, signed, unit }) {
      const between = (from, to) => `${from ?? "−∞"} … ${to ?? "∞"} ${unit}`.trim();
      if (signed) return `|${this.words.size}| ${between(least, most)}`;
      return between(least, most) + (negative === null ? "" : ` ${this.words.or} ${between(-most, negative)}`);
    },
    place(key) {
      return [...this.$el.querySelectorAll(".field")].find((each) => each.dataset.key === key);
    },
    reveal(key, scroll = true) {
      const place = this.place(key);
      for (let around = place?.closest("details"); around; around = around.parentElement.closest("details")) around.open = true;
      if (scroll && place) {
        this.bring(place);
        requestAnimationFrame(() => this.bring(place)); // once what comes into sight has its height
      }
      return place;
    },
    // Scroll as far as needed: the field, and what is wrong with it, is below the search and above the hint.
    bring(place) {
      const [find, hint] = [this.$refs.find, this.$refs.hint].map((each) => each.offsetHeight + 2);
      for (const each of [place.querySelector(".box"), place.querySelector(".fault")].filter(Boolean)) {
        each.style.scrollMargin = `${find}px 0 ${hint}px`;
        each.scrollIntoView({ block: "nearest" });
      }
    },
    pressHold(what) {
      this.flush(true);
      this.typing.key = "";
      this.$emit("hold", { what });
    },
    // What is told elsewhere leads to the field that it is about.
    led(event) {
      this.go(event.detail.key);
    },
    go(key) {
      this.wanted = "";
      this.$nextTick(() => this.reveal(key)?.querySelector("input, select").focus());
    },
    type(key, text) {
      this.drafts[key] = text;
      this.send(key, text);
    },
    // Nothing typed may arrive after a button that is pressed next.
    leave(key) {
      this.focused = null;
      this.flush(true);
      if (this.pending(key)) this.left.add(key);
      else this.forget(key);
    },
    // Let go of what was typed, but for what could not be written into the spec: that is only here.
    forget(key, all = false) {
      this.left.delete(key);
      if (all || (this.faultAt(key)?.written ?? true)) delete this.drafts[key];
    },
    out(key) {
      delete this.drafts[key];
      this.send(key, "");
      this.place(key)?.querySelector("input, select").focus();
    },
    press(field, event) {
      if (event.key === "Enter") {
        event.preventDefault();
        this.next(event);
      } else if (event.key === "Escape") event.target.blur();
      else if (field.number && (event.key === "ArrowUp" || event.key === "ArrowDown")) {
        event.preventDefault();
        const step = () => this.step(field, (event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : 1));
        this.undoing() ? this.later.push(step) : step();
      }
    },
    // Of an open list Enter and Escape choose and close.
    choose(event) {
      if (CSS.supports("selector(select:open)") && event.target.matches(":open")) return;
      if (event.key === "Enter") {
        event.preventDefault();
        this.next(event);
      } else if (event.key === "Escape") event.target.blur();
    },
    next(event) {
      const all = [...this.$el.querySelectorAll("input, select")].filter((each) => each.offsetParent);
      const at = all.indexOf(event.target) + (event.shiftKey ? -1 : 1);
      all[at]?.focus();
      if (all[at]?.select) all[at].select();
    },
    step(field, times) {
      const text = String((this.drafts[field.key] ?? this.given[field.key]) || (this.used[field.key] ?? "")).replace(",", ".").replace("−", "-");
      const value = Number(text);
      if (text.trim() === "" || Number.isNaN(value) || this.readonly) return;
      const typed = (text.split(".")[1] ?? "").length;
      const digits = field.whole ? 0 : typed || (Math.abs(value) < 10 ? 1 : 0);
      const stepped = (value + times * 10 ** -digits).toFixed(digits);
      this.type(field.key, decimal(Number(stepped) === 0 ? stepped.replace("-", "") : stepped));
    },
    send(key, text) {
      const now = performance.now(), typing = this.typing, last = this.queue.at(-1);
      if (key !== typing.key || now - typing.at > PAUSE) typing.step++;
      Object.assign(typing, { key, at: now });
      if (last?.key === key && last.step === typing.step) last.text = text;
      else this.queue.push({ key, text, step: typing.step });
      this.flush();
    },
    undo(forth) {
      this.typing.key = "";
      this.queue.push({ forth });
      this.flush();
    },
    flush(all = false) {
      while (this.queue.length && (all || !this.changes.sent.length)) this.changes.send(this.queue.shift());
    },
    flushed() {
      this.flush(true);
    },
    // What was typed since the last undo, and was not heard.
    keep() {
      const all = [...this.changes.sent, ...this.queue];
      const typed = all.slice(all.findLastIndex((change) => "forth" in change) + 1);
      keepUnheard("inputs", typed.length ? typed.map(({ key, text }) => ({ key, text })) : null);
    },
    hear(number) {
      this.changes.hear(number);
      this.flush();
    },
    pending(key) {
      return [...this.changes.sent, ...this.queue].some((change) => change.key === key);
    },
    undoing() {
      return [...this.changes.sent, ...this.queue].some((change) => "forth" in change);
    },
    shortcut(event) {
      const typing = event.target.closest?.("input, textarea, select, [contenteditable=true]");
      const ours = this.$el.contains(event.target) && event.target !== this.$refs.search;
      const key = event.key.toLowerCase();
      if ((event.ctrlKey || event.metaKey) && !event.altKey && (key === "z" || key === "y")) {
        if (typing && !ours) return;
        event.preventDefault();
        this.undo(key === "y" || event.shiftKey);
      } else if (key === "/" && !typing) {
        event.preventDefault();
        this.$refs.search.focus();
        this.$refs.search.select();
      }
    },
  },
};
