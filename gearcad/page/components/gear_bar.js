// Light or dark, as the system has it until somebody chooses; and which keys the page knows.
const STORE = "gearcad-dark";

export default {
  template: `
    <span class="bar-own">
      <span class="print-only">gearcad · {{ date }}</span>
      <button type="button" class="print" :aria-label="words.print" :title="words.print" @click="print"><q-icon name="print" size="16px" /></button>
      <button type="button" :aria-label="words.dark" :title="words.dark" @click="change">◐</button>
      <button type="button" :aria-label="words.keys" :title="words.keys + '  ?'" @click="open">?</button>
      <dialog ref="keys" class="keys" :aria-label="words.keys">
        <h2>{{ words.keys }}</h2>
        <dl><template v-for="[key, does] in keys" :key="key"><dt><kbd>{{ key }}</kbd></dt><dd>{{ does }}</dd></template></dl>
        <form method="dialog"><button autofocus>{{ words.close }}</button></form>
      </dialog>
    </span>`,
  props: { words: Object, keys: Array },
  data() {
    return { date: "" };
  },
  mounted() {
    try {
      const chosen = localStorage.getItem(STORE);
      if (chosen) Quasar.Dark.set(chosen === "dark");
    } catch {
      // A browser that keeps nothing follows the system.
    }
    window.addEventListener("keydown", this.pressed);
    window.addEventListener("beforeprint", this.dated);
  },
  unmounted() {
    window.removeEventListener("keydown", this.pressed);
    window.removeEventListener("beforeprint", this.dated);
  },
  methods: {
    change() {
      const dark = !document.body.classList.contains("body--dark");
      Quasar.Dark.set(dark);
      try {
        localStorage.setItem(STORE, dark ? "dark" : "light");
      } catch {
        // It is chosen for this tab only.
      }
    },
    print() {
      window.print();
    },
    // A report says of which day it is.
    dated() {
      this.date = new Date().toLocaleDateString(document.documentElement.lang, { dateStyle: "medium" });
    },
    open() {
      if (!this.$refs.keys.open) this.$refs.keys.showModal();
    },
    pressed(event) {
      const typing = event.target.closest?.("input, textarea, select, [contenteditable=true]");
      if (event.key !== "?" || typing || event.ctrlKey || event.altKey || event.metaKey) return;
      event.preventDefault();
      this.open();
    },
  },
};
