// Changes on their way to the server. Each has a number, and the server answers with the last number it has heard, so that none is
// lost, applied twice or out of order, however slow the server or the connection is.
const PATIENCE = 3000; // ms after which a change without an answer is sent again

export const PAUSE = 1000; // ms without a key after which typing is another step to undo

// What a tab has typed and the server has not heard when the page is loaded again: it is sent then, to the same design.
function asked() {
  const query = new URLSearchParams(window.location.search);
  query.delete("tab"); // each page that is loaded has another one
  return query.toString();
}
const place = (name) => `gearcad-unheard-${name}`;

export function keepUnheard(name, unheard) {
  try {
    if (unheard) sessionStorage.setItem(place(name), JSON.stringify({ search: asked(), unheard }));
    else sessionStorage.removeItem(place(name));
  } catch {
    // A browser that keeps nothing loses it.
  }
}

export function takeUnheard(name) {
  try {
    const { search, unheard } = JSON.parse(sessionStorage.getItem(place(name))) ?? {};
    sessionStorage.removeItem(place(name));
    return search === asked() ? (unheard ?? null) : null;
  } catch {
    return null;
  }
}

export class Changes {
  constructor(emit) {
    [this.emit, this.sent, this.number] = [emit, [], 0];
  }
  send(change) {
    this.sent.push({ ...change, number: ++this.number });
    this.emit(this.sent.at(-1));
    this.wait();
  }
  // The server has the changes up to this number.
  hear(number) {
    this.sent = this.sent.filter((change) => change.number > number);
    this.wait();
  }
  wait() {
    this.end();
    if (this.sent.length) this.timer = setTimeout(() => (this.sent.forEach((change) => this.emit(change)), this.wait()), PATIENCE);
  }
  end() {
    clearTimeout(this.timer);
  }
}
