// A questionnaire. What was typed stays while the form is on the screen, also when the language
// changes and changes back; a form that is asked again is empty.

import { el, pictureOf } from "./dom.js";
import { formItem } from "./form_items.js";
import { markedText } from "./marked_text.js";
import { word } from "./words.js";

let drafts = { number: null, byLanguage: new Map() };

function valuesOf(items) {
  const answered = items.filter((item) => item.value() !== null);
  return Object.fromEntries(answered.map((item) => [item.name, item.value()]));
}

// Which items are asked, as protocols/form.cpp decides it.
function asked(items) {
  const found = new Map();
  for (const item of items) {
    const { askedIf } = item;
    if (!askedIf || found.get(askedIf.item)?.isAnswered(askedIf.is)) found.set(item.name, item);
  }
  return [...found.values()];
}

function showAsked(items) {
  const shown = new Set(asked(items));
  items.forEach((item) => { item.element.hidden = !shown.has(item); });
}

function build({ form }) {
  const items = form.items.map((item, index) => formItem(item, `item-${index}`));
  const { title, body } = markedText(form.text);
  const send = el("button", { type: "submit", className: "main", id: "confirm" }, word("send"));
  const element = el("form", { className: "form", noValidate: true, autocomplete: "off" },
    el("h1", { tabIndex: -1 }, form.title || title || word("form")),
    form.title && title ? el("h2", {}, title) : null,
    ...body, pictureOf(form.picture), ...items.map((item) => item.element), send);
  // Enter in a field must not send a form that is half filled in.
  element.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && event.target.matches("input")) event.preventDefault();
  });
  element.addEventListener("input", () => showAsked(items));
  showAsked(items);
  return { element, items };
}

export function formScreen(screen, { send, say }) {
  if (drafts.number !== screen.number) drafts = { number: screen.number, byLanguage: new Map() };
  const { language } = screen;
  if (!drafts.byLanguage.has(language)) drafts.byLanguage.set(language, build(screen));
  const { element, items } = drafts.byLanguage.get(language);

  element.onsubmit = async (event) => {
    event.preventDefault();
    const toAnswer = asked(items);
    const ending = toAnswer.find((item) => item.endsSession());
    const wrong = ending ? [] : toAnswer.filter((item) => !item.check());
    if (wrong.length > 0) {
      say(word("form_incomplete", { count: wrong.length }));
      wrong[0].focus();
    } else {
      await send("form", valuesOf(ending ? [ending] : toAnswer));  // after such an answer nothing else counts
    }
  };
  return { element };
}
