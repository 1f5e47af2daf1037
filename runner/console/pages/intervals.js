// Alternatives that come one after the other: which one is to be tapped now.

import { el } from "./dom.js";
import { cardOf } from "./answer_fields.js";
import { word } from "./words.js";

export function intervalCard({ label, option, group, keys }) {
  const name = el("span", { className: "interval" }, word("interval_name", { label }));
  if (option < 0) return el("div", { className: "alternative only-felt" }, name);
  return el("div", { className: "alternative" }, name, cardOf({ group, option, label, keys }));
}

// The line that says what to do, and the button for all of them once more.
export function goSignal(replay) {
  return el("div", { className: "go-signal" },
    el("p", { className: "go", role: "status" }),
    el("button", { type: "button", className: "replay", hidden: true, onclick: replay }));
}

export function showInterval(element, { intervals, alternatives, current, is_tapped_by_script: isScripted }) {
  const { phase, replays_left: left } = intervals;
  const line = element.querySelector(".go");
  const signal = phase === "open" && isScripted ? "interval_open_scripted" : `interval_${phase}`;
  const text = word(signal, { label: alternatives[current] });
  if (line.textContent !== text) line.textContent = text;
  line.dataset.phase = phase;
  element.querySelectorAll(".interval").forEach((name, at) => {
    name.toggleAttribute("data-open", phase === "open" && at === current);
  });
  const button = element.querySelector(".replay");
  button.hidden = phase !== "over" || left === 0;
  button.textContent = word("replay", { count: left });
}
