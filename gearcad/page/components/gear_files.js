// Open, save, take along: a menu. A file that is opened goes to the server by a request of its own, which bounds its size.
const REJOINED = 2000; // ms after which a page that is connected again is not loaded again

export default {
  template: `
    <details class="files" ref="menu" @keydown.esc="close">
      <summary>{{ words.file }}<b v-if="unsaved" class="unsaved" role="img" :title="words.unsaved" :aria-label="words.unsaved">●</b></summary>
      <div class="files-menu">
        <section>
          <button type="button" @click="send('new', {})">{{ words.new }}</button>
          <h3>{{ words.open }}</h3>
          <label class="pick">{{ words.browse }}<input type="file" accept=".toml,text/plain" @change.stop="give('spec', $event)" /></label>
          <button v-for="name in specs" :key="name" type="button" @click="send('open', { name })">{{ name }}</button>
          <details><summary>{{ words.starters }}</summary>
            <button v-for="each in starters" :key="each.name" type="button" :title="each.words" @click="send('begin', { name: each.name })">
              {{ each.name }}<small>{{ each.words }}</small></button>
          </details>
          <h3>{{ words.table }}</h3>
          <label class="pick">{{ words.browse }}<input type="file" accept=".csv,.tsv,text/csv" @change.stop="give('table', $event)" /></label>
          <button v-for="name in tables" :key="name" type="button" @click="send('table', { name })">{{ name }}</button>
        </section>
        <section>
          <h3>{{ words.save }}</h3>
          <button type="button" @click="send('spec', {})">{{ words.spec }}</button>
          <form @submit.prevent="save(false)">
            <input v-model="name" :aria-label="words.name" spellcheck="false" autocomplete="off" /><button>{{ words.store }}</button>
          </form>
          <p v-if="taken" class="fault" role="alert"><span>{{ taken }}</span> <button type="button" @click="save(true)">{{ words.replace }}</button></p>
          <p v-if="saved" role="status">{{ saved }}</p>
          <h3>{{ words.along }}</h3>
          <div class="makes">
            <button v-for="make in makes" :key="make.key" type="button" :disabled="!!making" @click="send('make', { kind: make.key })">{{ make.words }}</button>
          </div>
          <p v-if="making" role="status">{{ making }} <button type="button" @click="send('stop', {})">{{ words.cancel }}</button></p>
          <h3>{{ words.link }}</h3>
          <button type="button" :disabled="!link" @click="copy">{{ copied ? words.copied : words.copy }}</button>
        </section>
        <p v-if="line" class="fault" role="alert">{{ line }}</p>
      </div>
    </details>`,
  props: { tab: String, words: Object, address: String },
  emits: ["asked"],
  data() {
    return {
      specs: [], tables: [], starters: [], makes: [], making: "", name: "", taken: "", saved: "", line: "", link: "", copied: false,
      file: "", unsaved: false,
    };
  },
  mounted() {
    const query = new URLSearchParams(window.location.search);
    query.set("tab", this.tab); // a page that is loaded again before anything was typed is the same one, too
    window.history.replaceState(window.history.state, "", `${window.location.pathname}?${query}`);
    this.listening = new AbortController();
    const { signal } = this.listening;
    window.addEventListener("keydown", this.key, { signal });
    window.addEventListener("beforeunload", this.ask, { signal });
    this.$nextTick(() => window.socket.on("disconnect", this.rejoin)); // the socket is there once the page is mounted
    this.$refs.menu.addEventListener("toggle", (event) => {
      if (event.target === this.$refs.menu && this.$refs.menu.open && !this.asking) this.send("look", {});
      this.asking = false;
    });
    this.outside = (event) => {
      if (!this.$refs.menu.contains(event.target)) this.$refs.menu.open = false;
    };
    document.addEventListener("pointerdown", this.outside);
  },
  unmounted() {
    document.removeEventListener("pointerdown", this.outside);
    window.socket?.off("disconnect", this.rejoin);
    this.listening.abort();
  },
  methods: {
    show(state) {
      Object.assign(this, state);
      if ("unsaved" in state) document.title = `${this.unsaved ? "● " : ""}${this.file} - gearcad`;
    },
    key(event) {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || event.shiftKey || event.key.toLowerCase() !== "s") return;
      event.preventDefault();
      window.dispatchEvent(new CustomEvent("gear-flush")); // what was typed goes before
      this.send("save-open", {});
    },
    // The browser asks before a design goes that no file has, unless another page takes it over.
    ask(event) {
      if (this.unsaved && !this.leaving && !this.rejoining) event.preventDefault();
    },
    leaveFor(address) {
      this.leaving = true;
      window.location.assign(address);
    },
    // A server that has lost this page has it loaded again at once; the address and this tab keep the design.
    rejoin() {
      window.socket.once("connect", () => {
        this.rejoining = true;
        clearTimeout(this.joined);
        this.joined = setTimeout(() => (this.rejoining = false), REJOINED);
      });
    },
    open() {
      this.asking = !this.$refs.menu.open; // what it asks stays
      this.$refs.menu.open = true;
    },
    follow(link) {
      // The address holds the design, for who loads the page anew, and the language that was asked for; no token.
      const asked = new URLSearchParams(window.location.search);
      const kept = new URLSearchParams();
      if (asked.get("lang")) kept.set("lang", asked.get("lang"));
      if (link) kept.set("design", link);
      const query = kept.toString();
      this.link = link ? `${window.location.origin}${window.location.pathname}?${query}` : "";
      this.copied = false;
      if (asked.get("units")) kept.set("units", asked.get("units")); // those of the reader
      kept.set("tab", this.tab); // not in the link: the steps of this tab are its own
      window.history.replaceState(window.history.state, "", window.location.pathname + `?${kept}`);
    },
    close() {
      this.$refs.menu.open = false;
      this.$refs.menu.querySelector("summary").focus();
    },
    send(what, told) {
      this.$emit("asked", { what, ...told });
    },
    save(replace) {
      this.send("save", { name: this.name, replace });
    },
    async give(what, event) {
      const file = event.target.files[0];
      event.target.value = "";
      if (!file) return;
      const answer = await fetch(`${this.address}/${what}?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file });
      this.line = answer.ok ? this.line : `${file.name}: ${await answer.text()}`;
    },
    async copy() {
      try {
        await navigator.clipboard.writeText(this.link);
      } catch {
        // Without https a page may not write there itself.
        const held = document.createElement("textarea");
        held.value = this.link;
        document.body.append(held);
        held.select();
        document.execCommand("copy");
        held.remove();
      }
      this.copied = true;
    },
  },
};
