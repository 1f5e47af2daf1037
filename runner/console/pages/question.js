// A question with an answer to pick or to enter, and the button that sends it.

import { el } from "./dom.js";
import { pickedValue } from "./radio_cards.js";
import { word } from "./words.js";

// answerIn(element): the answer as text, null as long as there is none: `missing` (words, or a function
// that gives them) is said then.
// label: of the button; an answer that is stored only with what is asked next is not confirmed yet.
// entered(answer) is called as it changes; send(value as text) once there is one and it is confirmed.
export function question({ title, className, body, say, send, answerIn = pickedValue, missing = word("pick_first"), entered = () => {}, label = word("confirm") }) {
  const confirm = el("button", { type: "submit", className: "main", id: "confirm", "aria-disabled": "true" }, label);
  const element = el("form", { className, noValidate: true, autocomplete: "off" },
    el("fieldset", {}, el("legend", {}, el("h1", { tabIndex: -1 }, title)), ...body),
    confirm);

  function follow() {
    const answer = answerIn(element);
    confirm.setAttribute("aria-disabled", String(answer === null));
    entered(answer);
  }
  follow();
  element.addEventListener("change", follow);
  element.addEventListener("input", follow);
  function submit() {
    const value = answerIn(element);
    if (value === null) say(typeof missing === "function" ? missing() : missing);
    else send(value);
    return true;
  }
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    submit();
  });
  return { element, submit };
}
