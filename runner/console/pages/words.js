// The page's own words: in the browser's language, and for participants in the session's. Texts of
// the study come ready-made.

let all = { en: {} };
let words = {};

export async function loadWords() {
  const response = await fetch("messages.json");
  if (!response.ok) throw new Error(`messages.json: ${response.status}`);
  all = await response.json();
  const preferred = navigator.languages.map((tag) => tag.slice(0, 2)).find((tag) => tag in all);
  setLanguage(preferred ?? "en");
}

export function setLanguage(language) {
  const known = language in all ? language : "en";
  words = all[known];
  document.documentElement.lang = known;
}

export function word(key, values = {}) {
  const text = words[key] ?? all.en[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (whole, name) => values[name] ?? whole);
}

// How long the session has taken and will take, in minutes.
function timeIn({ elapsed_s: elapsed, left_s: left }) {
  const minutes = Math.floor(elapsed / 60);
  return left === null ? word("time_so_far", { minutes }) : word("time_and_left", { minutes, left: Math.ceil(left / 60) });
}

// Goes on between the program's messages, which say how long it was when the trial began; until the
// session is over, in pauses and rests too.
export class SessionTime {
  constructor(show) {
    this.show = show;
    this.progress = null;
    this.isOver = false;
    setInterval(() => { if (this.progress && !this.isOver) this.show(); }, 5000);
  }

  // null: nothing new is known.
  note(progress, isOver) {
    if (progress && progress.elapsed_s !== this.progress?.elapsed_s) this.at = performance.now();
    this.progress = progress ?? this.progress;
    if (isOver && !this.isOver) this.endedAt = performance.now();
    this.isOver = isOver;
  }

  text() {
    const until = this.isOver ? this.endedAt : performance.now();
    return timeIn({ ...this.progress, elapsed_s: this.progress.elapsed_s + (until - this.at) / 1000 });
  }
}

// For names that come from the program and may be newer than these pages.
export const wordOr = (key, otherwise) => words[key] ?? otherwise;
