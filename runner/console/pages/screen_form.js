// A questionnaire. What was typed stays until the form is accepted, whatever comes in between.

import { el } from "./dom.js";
import { formItem } from "./form_items.js";
import { markedText } from "./marked_text.js";
import { word } from "./words.js";

const drafts = new Map();

function valuesOf(items) {
  const answered = items.filter((item) => item.value() !== null);
  return Object.fromEntries(answered.map((item) => [item.name, item.value()]));
}

function build({ form }) {
  const items = form.items.map((item, index) => formItem(item, `item-${index}`));
  const { title, body } = markedText(form.text);
  const send = el("button", { type: "submit", className: "main", id: "confirm" }, word("send"));
  const element = el("form", { className: "form", noValidate: true, autocomplete: "off" },
    el("h1", { tabIndex: -1 }, form.title || title || word("form")),
    form.title && title ? el("h2", {}, title) : null,
    ...body, ...items.map((item) => item.element), send);
  // Enter in a field must not send a form that is half filled in.
  element.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && event.target.matches("input")) event.preventDefault();
  });
  return { element, items };
}

export function formScreen(screen, { send, say }) {
  const key = JSON.stringify([screen.form, screen.language]);
  if (!drafts.has(key)) drafts.set(key, build(screen));
  const { element, items } = drafts.get(key);
  let isSent = false;

  element.onsubmit = async (event) => {
    event.preventDefault();
    const wrong = items.filter((item) => !item.check());
    if (wrong.length > 0) {
      say(word("form_incomplete", { count: wrong.length }));
      wrong[0].focus();
    } else {
      isSent = true;
      isSent = await send("form", valuesOf(items));
    }
  };
  // The reply may be lost, but the screen after the form tells that it has arrived.
  return { element, leave: (next) => { if (isSent && next !== "paused") drafts.delete(key); } };
}
