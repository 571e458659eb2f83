// Numbers and their units as the page shows them: those of the documents, or others that the page names with their sizes.
export const fixed = (value, digits) =>
  value.toLocaleString(document.documentElement.lang || "en", { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });

// The name of the unit that is shown for one of the documents, and its size in the latter: "mm|in|25.4 µm|µin|0.0254".
export function shownUnit(unit) {
  const [, name, size] = (document.documentElement.dataset.units ?? "").split(" ").map((each) => each.split("|")).find(([own]) => own === unit) ?? [unit, unit, 1];
  return { name, size: Number(size) };
}

// A number of the documents in the unit that is shown; digits are those that it has in the documents.
export function shownNumber(value, digits, unit) {
  const { size } = shownUnit(unit);
  return fixed(value / size, Math.max(digits + Math.round(Math.log10(size)), 0));
}

export const shown = (value, digits, unit) => `${shownNumber(value, digits, unit)} ${shownUnit(unit).name}`;
export const stored = (value, unit) => value * shownUnit(unit).size;
