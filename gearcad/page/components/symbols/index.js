// A symbol, or words with symbols in them, with indices below the line: pieces of text, each with the index behind it.
export const GearSymbol = {
  template: `<template v-for="([text, index], at) in parts" :key="at">{{ text }}<sub v-if="index">{{ index }}</sub></template>`,
  props: { parts: Array },
};
