// A visual analogue scale: a line without a mark until it is touched.

import { el } from "./dom.js";
import { anchors } from "./radio_cards.js";
import { word } from "./words.js";

const middle = 0.5;

// {body, input, value() (0 to 1, null: no mark), clear()}
export function analogueScale({ low, high, label }) {
  const input = el("input", { type: "range", min: 0, max: 1, step: 0.01, value: middle, "aria-label": label });
  const hint = el("p", { className: "hint", "aria-hidden": "true" }, word("scale_hint"));
  const body = el("div", { className: "scale" }, input, anchors(low, high), hint);
  let isTouched = false;
  function setTouched(is) {
    isTouched = is;
    input.classList.toggle("is-touched", is);
    hint.style.visibility = is ? "hidden" : "visible";
    const percent = Math.round(100 * input.value);
    input.setAttribute("aria-valuetext", is ? word("scale_value", { percent, low, high }) : word("scale_untouched"));
  }
  function touch() {
    if (isTouched) return;
    setTouched(true);
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }
  input.addEventListener("input", () => setTouched(true));
  input.addEventListener("pointerup", touch);
  input.addEventListener("keydown", (event) => { if (event.key === " ") touch(); });
  setTouched(false);
  return {
    body,
    input,
    value: () => (isTouched ? Number(input.value) : null),
    clear: () => { input.value = middle; setTouched(false); },
  };
}
