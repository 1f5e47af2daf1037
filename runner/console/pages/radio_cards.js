// Answers to pick from: radio buttons, or boxes to check, that look like cards.

import { el, pictureOf } from "./dom.js";

let groups = 0;

export const newGroupName = () => `group-${(groups += 1)}`;

// key: the key that picks it, shown beside the label.
function card({ type, group, value, label, picture, key, spokenLabel }) {
  const input = el("input", { type, name: group, value: String(value), "aria-label": spokenLabel });
  const hint = key ? el("kbd", { "aria-hidden": "true" }, key) : null;
  return el("label", { className: "option" }, input, el("span", { className: "face" }, hint, pictureOf(picture), el("span", {}, label)));
}

export const radioCard = (parts) => card({ type: "radio", ...parts });
export const checkCard = (parts) => card({ type: "checkbox", ...parts });

export function steps({ count, low, high, keys = [] }) {
  const group = newGroupName();
  const ends = { 1: low, [count]: high };
  const cards = Array.from({ length: count }, (_, index) => {
    const value = index + 1;
    const spokenLabel = ends[value] ? `${value} ${ends[value]}` : String(value);
    return radioCard({ group, value, label: String(value), key: keys[index], spokenLabel });
  });
  const row = el("div", { className: "steps" }, ...cards);
  // So that all steps stand in one row wherever they fit.
  row.style.setProperty("--count", count);
  return el("div", { className: "scale" }, row, anchors(`1 – ${low ?? ""}`, `${count} – ${high ?? ""}`));
}

export function anchors(low, high) {
  return el("div", { className: "anchors", "aria-hidden": "true" }, el("span", {}, low), el("span", {}, high));
}

export function pickedValue(element) {
  const input = element.querySelector("input[type=radio]:checked");
  return input ? input.value : null;
}

// Picks the n-th answer, from 1; false if there is none.
export function pickNumber(element, key) {
  if (!/^[1-9]\d?$/.test(key)) return false;
  const input = element.querySelectorAll("input[type=radio]")[Number(key) - 1];
  if (!input) return false;
  input.focus();
  input.click();
  return true;
}
