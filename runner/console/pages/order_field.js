// Options put in order: pressed one after the other, the first of the order first. Pressed once more,
// an option leaves the order again, and those behind it move up.

import { el } from "./dom.js";
import { word } from "./words.js";

function placeButton(label, index, toggle) {
  const place = el("span", { className: "place" });
  return el("button", { type: "button", className: "in-order", onclick: () => toggle(index) },
    el("kbd", { "aria-hidden": "true" }, String(index + 1)), el("span", {}, label), place);
}

function showPlace(button, place) {
  const isPlaced = place >= 0;
  button.setAttribute("aria-pressed", String(isPlaced));
  button.querySelector(".place").textContent = isPlaced ? word("order_place", { place: place + 1 }) : "";
}

// {body, answer(), toggle(index)}; the answer is null until all are in the order.
export function orderOf(options) {
  let order = [];
  const line = el("p", { className: "order", role: "status" });
  const buttons = options.map((label, index) => placeButton(label, index, toggle));
  const list = el("div", { className: "orderable" }, ...buttons);
  function show() {
    buttons.forEach((button, index) => showPlace(button, order.indexOf(index)));
    line.textContent = order.length === 0
      ? word("order_none") : word("order_so_far", { labels: order.map((index) => options[index]).join(", ") });
  }
  function toggle(index) {
    order = order.includes(index) ? order.filter((one) => one !== index) : [...order, index];
    show();
    list.dispatchEvent(new Event("change", { bubbles: true }));
  }
  show();
  return {
    body: [list, line],
    answer: () => (order.length === options.length ? order.map((index) => String(index + 1)).join(" ") : null),
    toggle,
  };
}
