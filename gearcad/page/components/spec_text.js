// The text of a spec. One change is on its way at a time: what is typed meanwhile is kept apart, and stays in its place when the
// text is changed elsewhere, as by an undo.
import * as CM from "nicegui-codemirror";
import { Changes, PAUSE, keepUnheard, takeUnheard } from "gear-changes";

const ofServer = CM.Annotation.define();
const wrong = CM.StateEffect.define(); // the number of the line that is wrong, or null

const wrongLine = CM.StateField.define({
  create: () => CM.Decoration.none,
  update(marks, { changes, effects, state: { doc } }) {
    marks = marks.map(changes);
    for (const { value } of effects.filter((effect) => effect.is(wrong))) {
      const lines = value && value <= doc.lines ? [CM.Decoration.line({ class: "wrong-line" }).range(doc.line(value).from)] : [];
      marks = CM.Decoration.set(lines);
    }
    return marks;
  },
  provide: (field) => CM.EditorView.decorations.from(field),
});

// The change from one text to another, of the part in which they differ.
function changeBetween(old, text) {
  let [start, end, to] = [0, old.length, text.length];
  while (start < end && start < to && old[start] === text[start]) start++;
  while (end > start && to > start && old[end - 1] === text[to - 1]) [end, to] = [end - 1, to - 1];
  return CM.ChangeSet.of({ from: start, to: end, insert: text.slice(start, to) }, old.length);
}

export default {
  template: `<div class="spec-text"></div>`,
  props: { label: String },
  emits: ["typed", "step"],
  async mounted() {
    this.changes = new Changes((change) => this.$emit("forth" in change ? "step" : "typed", change));
    this.typing = { at: 0, step: 0 };
    this.server = ""; // the text when all that was sent is taken in
    this.local = CM.ChangeSet.empty(0); // what was typed since
    const keys = Object.entries({ "Mod-z": false, "Mod-y": true, "Mod-Shift-z": true });
    const language = new CM.Compartment();
    this.editor = new CM.EditorView({
      parent: this.$el,
      extensions: [
        CM.Prec.high(CM.keymap.of(keys.map(([key, forth]) => ({ key, run: () => (this.undo(forth), true) })))),
        CM.basicSetup,
        CM.keymap.of([CM.indentWithTab]),
        CM.indentUnit.of("  "),
        CM.themes.githubLight,
        CM.EditorView.contentAttributes.of({ "aria-label": this.label }),
        CM.EditorView.updateListener.of(this.updated),
        CM.EditorView.domEventHandlers({ blur: () => this.flush(true) }),
        wrongLine,
        language.of([]),
      ],
    });
    window.addEventListener("gear-flush", this.flushed);
    window.addEventListener("pagehide", this.keep);
    const unheard = takeUnheard("text");
    if (unheard !== null) this.changes.send({ text: unheard, step: ++this.typing.step });
    const toml = await CM.languages.find((each) => each.name === "TOML").load();
    this.editor.dispatch({ effects: language.reconfigure(toml) });
  },
  unmounted() {
    window.removeEventListener("gear-flush", this.flushed);
    window.removeEventListener("pagehide", this.keep);
    this.changes.end();
    this.editor.destroy();
  },
  methods: {
    // Show the text and its wrong line; `heard` is the number of the last change that is in it.
    show({ text, line, heard }) {
      this.changes.hear(heard);
      if (this.changes.sent.length) return;
      if (text !== this.server) {
        const changes = changeBetween(this.server, text);
        this.editor.dispatch({ changes: changes.map(this.local), annotations: ofServer.of(true) });
        [this.local, this.server] = [this.local.map(changes, true), text];
      }
      if (this.local.empty) this.editor.dispatch({ effects: wrong.of(line) });
      this.flush();
    },
    hear(number) {
      this.changes.hear(number);
      this.flush();
    },
    updated({ docChanged, changes, transactions }) {
      if (!docChanged || transactions.some((each) => each.annotation(ofServer))) return;
      const now = performance.now();
      if (now - this.typing.at > PAUSE) this.typing.step++;
      this.typing.at = now;
      this.local = this.local.compose(changes);
      this.flush();
    },
    undo(forth) {
      this.flush(true);
      this.typing.at = -PAUSE;
      this.changes.send({ forth });
    },
    flushed() {
      this.flush(true);
    },
    keep() {
      const isHeard = this.local.empty && !this.changes.sent.some((change) => "text" in change);
      keepUnheard("text", isHeard ? null : this.editor.state.doc.toString());
    },
    flush(all = false) {
      if (this.local.empty || (this.changes.sent.length && !all)) return;
      this.server = this.editor.state.doc.toString();
      this.local = CM.ChangeSet.empty(this.server.length);
      this.changes.send({ text: this.server, step: this.typing.step });
    },
  },
};
