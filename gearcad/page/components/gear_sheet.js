// Blocks of quantities as tables: words, symbol, unit, values. What changed by the last step stands beside what it was, and what a
// kept design has in lines below. Rows are walked by the arrow keys; Enter puts one on top, or takes it from there. Values of gears
// stand under their gear, those of the mesh across all of them.
import { GearSymbol } from "gear-symbols";

const NUMBER = /^([^\p{L}\d]*\d+)([.,]\d+)?(e[+-]?\d+)?$/u;
const FEW = 3;
const LONG = 6; // characters of a unit
const DECIMALS = 6; // characters behind a decimal point for which two columns have room everywhere
const WORDS = 280, COLUMN = 100; // pixels that words with symbol and unit, and a value, need

// The part of a number before its point and the rest, to be put in line; null for what is no number.
function split(text) {
  const found = NUMBER.exec(text);
  return found ? [found[1], (found[2] ?? "") + (found[3] ?? "")] : [text, null];
}

// A quantity. Its part of the page stays as it is while all that it is given does.
const SheetRow = {
  template: `
    <tbody>
      <tr :data-row="row.key" :title="hint" :tabindex="stop ? 0 : -1" @focus="sheet.at = place" @dblclick="sheet.pin(row.key)">
        <th scope="row"><gear-symbol :parts="row.parts[0]" /></th><td class="symbol"><gear-symbol :parts="row.parts[1]" /></td><td class="unit">{{ divided(row.unit) }}</td>
        <td v-for="(cell, number) in row.cells" :key="number" class="value" :class="{ changed: cell.former, across: sheet.gears > 1 && row.cells.length === 1 }" :colspan="span" :data-column="row.cells.length > 1 ? columns[number] : null">
          <del v-if="cell.former" :class="{ number: split(cell.former)[1] !== null }">{{ cell.former }}</del> <span :class="{ number: split(cell.text)[1] !== null }"><span class="whole">{{ split(cell.text)[0] }}</span
          ><span class="rest" :style="{ minWidth: rest + 'ch' }" v-if="split(cell.text)[1] !== null">{{ split(cell.text)[1] }}</span></span>
        </td>
      </tr>
      <tr v-if="row.cells.some((cell) => cell.kept)" class="kept">
        <th scope="row" colspan="3">{{ sheet.words.kept }} <small>({{ sheet.words.difference }})</small></th>
        <td v-for="(cell, number) in row.cells" :key="number" class="value" :class="{ none: !cell.kept, across: sheet.gears > 1 && row.cells.length === 1 }" :colspan="span" :data-column="row.cells.length > 1 ? columns[number] : null">
          <small v-if="cell.difference" class="number">({{ cell.difference }})</small> <span :class="{ number: split(cell.kept ?? '')[1] !== null }"><span class="whole">{{ split(cell.kept ?? "")[0] }}</span
          ><span class="rest" :style="{ minWidth: rest + 'ch' }" v-if="split(cell.kept ?? '')[1] !== null">{{ split(cell.kept)[1] }}</span></span>
        </td>
      </tr>
    </tbody>`,
  components: { GearSymbol },
  props: { sheet: Object, row: Object, place: String, hint: String, stop: Boolean, columns: Array, span: Number, rest: Number },
  methods: {
    split,
    // A long unit may go on in the next line.
    divided(unit) {
      return unit.length > LONG ? unit.replace("/", "\u200b/") : unit;
    },
  },
};

export default {
  components: { SheetRow },
  template: `
    <section class="gear-sheet" :aria-label="label" :aria-busy="waiting" :data-stale="dataStale" @keydown="walk">
      <header>
        <h2 v-if="content.title" :class="dataStale || waiting ? '' : content.verdict">{{ content.title }}<template v-if="dataStale"> ({{ dataStale }})</template></h2>
        <p v-if="content.reason" class="told">{{ content.reason }}</p>
        <p v-if="content.beside" class="kept">{{ words.kept }}: {{ content.beside }}</p>
        <component :is="line.label ? 'details' : 'p'" v-for="line in content.lines" :key="line.label" class="told">
          <summary v-if="line.label">{{ words[line.label] }}</summary><span>{{ line.text }}</span></component>
        <input v-if="content.sections.length" class="search" type="search" v-model="wanted" :placeholder="words.search" :aria-label="words.search" />
        <p class="aside" role="status">{{ waiting ? label + ": " + words.waiting : content.changes ? words.changed + ": " + content.changes : "" }}</p>
      </header>
      <details v-if="content.notices.length" class="notices" :open="noticesOpen" @toggle="fold({ id: 'notices', open: noticesOpen }, $event.target.open)">
        <summary>{{ words.notices }} ({{ content.notices.length }})</summary>
        <ul><li v-for="notice in content.notices" :key="notice.text"><span>{{ notice.text + " " }}</span>
          <button v-for="key in notice.keys" :key="key" type="button" class="key" @click="focus(key)">{{ key }}</button></li></ul>
      </details>
      <details v-for="block in blocks" :key="block.id" :open="block.open || printing" @toggle="fold(block, $event.target.open)">
        <summary>{{ block.title }}</summary>
        <table v-for="table in block.tables" :key="table.columns.join()" :class="{ stacked: isStacked(table) }">
          <thead v-if="table.columns.length"><tr><th colspan="3"></th><th v-for="name in table.columns" :key="name" scope="col">{{ name }}</th></tr></thead>
          <sheet-row v-for="row in table.rows" :key="row.key" :sheet="me" :row="row" :place="block.id + row.key" :hint="hint(row)"
                     :stop="row === stops[block.id]" :columns="table.columns" :span="span(table, row)" :rest="table.rest" />
        </table>
      </details>
    </section>`,
  props: { label: String, store: String, words: Object, dataStale: String },
  data() {
    const kept = this.remembered();
    return {
      waiting: false,
      content: { title: "", reason: "", verdict: "", lines: [], beside: "", changes: 0, notices: [], sections: [], pins: [] },
      folds: kept.folds ?? {},
      pins: kept.pins ?? {},
      wanted: "",
      at: "",
      width: 0,
      printing: false,
    };
  },
  created() {
    this.said = new Map(); // rows by all that they say
  },
  mounted() {
    this.observer = new ResizeObserver(() => (this.width = this.$el.clientWidth));
    this.observer.observe(this.$el);
    window.addEventListener("beforeprint", this.unfold);
    window.addEventListener("afterprint", this.unfold);
  },
  unmounted() {
    this.observer.disconnect();
    window.removeEventListener("beforeprint", this.unfold);
    window.removeEventListener("afterprint", this.unfold);
  },
  computed: {
    // Few are read, many are opened by who wants them.
    noticesOpen() {
      return this.content.notices.length === 1 || (this.folds.notices ?? this.content.notices.length <= FEW);
    },
    // What is pinned first, then all blocks; of a search only what is found.
    blocks() {
      const wanted = this.wanted.trim().toLowerCase();
      const fits = (row) => !wanted || `${row.words} ${row.symbol} ${row.key}`.replaceAll("\u00ad", "").toLowerCase().includes(wanted);
      const found = [];
      const pinned = new Map();
      for (const { columns, blocks } of this.content.sections)
        for (const { id, title, folded, rows } of blocks) {
          for (const row of rows) if (this.pinned(row.key)) pinned.set(row.key, { row, columns });
          const open = !!wanted || (this.folds[id] ?? !folded);
          found.push({ id, title, open, tables: [this.table(columns, rows.filter(fits))] });
        }
      const order = [...this.content.pins, ...[...pinned.keys()].filter((key) => !this.content.pins.includes(key))];
      const top = order.filter((key) => pinned.has(key)).map((key) => pinned.get(key));
      if (!wanted) found.unshift({ id: "pins", title: this.words.pins, open: this.folds.pins ?? true, tables: this.together(top) });
      return found.filter((block) => block.tables.some((table) => table.rows.length));
    },
    me() {
      return this;
    },
    // Columns of the table of most gears: what is of the mesh stands across these.
    gears() {
      return Math.max(0, ...this.content.sections.map((section) => section.columns.length));
    },
    // The row of each block that the tab key comes to.
    stops() {
      const stop = ({ id, tables }) => {
        const rows = tables.flatMap((table) => table.rows);
        return [id, rows.find((row) => id + row.key === this.at) ?? rows[0]];
      };
      return Object.fromEntries(this.blocks.map(stop));
    },
  },
  methods: {
    // A row that says what it said stays the one that it was, and so does its part of the page.
    show(content) {
      const said = new Map();
      for (const block of content.sections.flatMap((section) => section.blocks))
        block.rows = block.rows.map((row) => {
          const text = JSON.stringify(row);
          const same = this.said.get(text) ?? row;
          said.set(text, same);
          return same;
        });
      this.said = said;
      this.content = Object.freeze(content); // so that Vue does not watch everything in it
      this.waiting = false;
    },
    wait() {
      this.waiting = true;
    },
    // Rows, and how much room what is behind their decimal points needs.
    table(columns, rows) {
      const rests = rows.flatMap((row) => row.cells.map((cell) => (split(cell.text)[1] ?? "").length));
      return { columns, rows, rest: Math.max(0, ...rests) };
    },
    // Pinned rows in a table for each kind of columns; one number of all goes with those of several gears before it.
    together(pinned) {
      const tables = [];
      for (const { row, columns } of pinned) {
        const key = columns.join();
        const same = tables.find((table) => table.key === key) ?? (!columns.length && tables.at(-1)?.columns.length > 1 ? tables.at(-1) : undefined);
        if (same) same.rows.push(row);
        else tables.push({ key, columns, rows: [row] });
      }
      return tables.map(({ columns, rows }) => this.table(columns, rows));
    },
    // Whether there is no room for the columns beside the words of a quantity.
    isStacked({ columns, rest }) {
      return !this.printing && (columns.length > 2 || rest > DECIMALS) && this.width < WORDS + COLUMN * columns.length;
    },
    pinned(key) {
      return this.pins[key] ?? this.content.pins.includes(key);
    },
    span(table, row) {
      return row.cells.length === 1 ? Math.max(table.columns.length, 1) : 1;
    },
    hint(row) {
      return [`${row.words} ${row.symbol}`, row.source, row.key, this.pinned(row.key) ? this.words.unpin : this.words.pin].filter(Boolean).join("\n");
    },
    walk(event) {
      const row = event.target.closest("tr[data-row]");
      if (!row || event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.key === "Enter") this.pin(row.dataset.row);
      else if (event.key === "ArrowDown" || event.key === "ArrowUp") {
        const rows = [...this.$el.querySelectorAll("details[open] tr[data-row]")];
        rows[rows.indexOf(row) + (event.key === "ArrowDown" ? 1 : -1)]?.focus();
      } else return;
      event.preventDefault();
    },
    pin(key) {
      this.pins = { ...this.pins, [key]: !this.pinned(key) };
      this.remember();
    },
    // A report on paper has all blocks open.
    unfold(event) {
      this.printing = event.type === "beforeprint";
      if (this.printing) this.shut = [...this.$el.querySelectorAll("details.told:not([open]), .notices:not([open])")];
      for (const each of this.shut ?? []) each.open = this.printing;
    },
    fold(block, open) {
      if (this.wanted || this.printing || open === block.open) return;
      this.folds = { ...this.folds, [block.id]: open };
      this.remember();
    },
    focus(key) {
      window.dispatchEvent(new CustomEvent("gear-focus", { detail: { key } }));
    },
    remembered() {
      try {
        return JSON.parse(localStorage.getItem(this.store)) ?? {};
      } catch {
        return {};
      }
    },
    remember() {
      try {
        localStorage.setItem(this.store, JSON.stringify({ folds: this.folds, pins: this.pins }));
      } catch {
        // A browser that keeps nothing forgets with the tab.
      }
    },
  },
};
