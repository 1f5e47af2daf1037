// A question with answers to pick from, and the button that sends the picked one.

import { el } from "./dom.js";
import { pickedValue } from "./radio_cards.js";
import { word } from "./words.js";

// send(value as text) is called once an answer is picked and confirmed.
export function question({ title, className, body, say, send }) {
  const confirm = el("button", { type: "submit", className: "main", id: "confirm", "aria-disabled": "true" }, word("confirm"));
  const element = el("form", { className, noValidate: true, autocomplete: "off" },
    el("fieldset", {}, el("legend", {}, el("h1", { tabIndex: -1 }, title)), ...body),
    confirm);

  element.addEventListener("change", () => {
    confirm.setAttribute("aria-disabled", String(pickedValue(element) === null));
  });
  function submit() {
    const value = pickedValue(element);
    if (value === null) say(word("pick_first"));
    else send(value);
    return true;
  }
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    submit();
  });
  return { element, submit };
}
