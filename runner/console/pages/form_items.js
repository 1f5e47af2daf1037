// The kinds of items in a form. Each has an element, value() (null: not answered) and problem(),
// the words for what is wrong with it or null.

import { analogueScale } from "./analogue_scale.js";
import { el, pictureOf } from "./dom.js";
import { checkCard, newGroupName, pickedValue, radioCard, steps } from "./radio_cards.js";
import { typedNumber } from "./typed_number.js";
import { word } from "./words.js";

function radios(body, valueOf) {
  return {
    body,
    value: () => {
      const picked = pickedValue(body);
      return picked === null ? null : valueOf(picked);
    },
    clear: () => body.querySelectorAll("input").forEach((input) => { input.checked = false; }),
  };
}

const likert = (item) => radios(steps({ count: item.steps, low: item.low, high: item.high }), Number);

function singleChoice(item) {
  const group = newGroupName();
  const cards = item.options.map(({ label, picture }, index) => radioCard({ group, value: index, label, picture }));
  return radios(el("div", { className: "options" }, ...cards), (index) => item.options[Number(index)].name);
}

// As protocols/form.hpp writes several choices.
const betweenChoices = ";";

function multipleChoice(item) {
  const cards = item.options.map(({ label, picture }, index) => checkCard({ value: index, label, picture }));
  const body = el("div", { className: "options" }, ...cards);
  const chosen = () => [...body.querySelectorAll("input:checked")].map(({ value }) => item.options[Number(value)].name);
  return { body, value: () => (chosen().length === 0 ? null : chosen().join(betweenChoices)) };
}

const scale = (item) => analogueScale({ low: item.low ?? "", high: item.high ?? "", label: item.question });

function rangeProblem(item, value) {
  const { min, max } = item;
  const isInside = (min ?? -Infinity) <= value && value <= (max ?? Infinity);
  if (isInside) return null;
  if (min === undefined || min === null) return word("at_most", { max });
  if (max === undefined || max === null) return word("at_least", { min });
  return word("between", { min, max });
}

// A field of type number drops a decimal comma where the browser speaks a language with points: 2,5
// would be 25.
function number(item, id) {
  const input = el("input", { type: "text", id, className: "number", inputMode: "decimal", autocomplete: "off" });
  const valueOf = ({ text }) => (text === null ? null : Number(text));
  return {
    body: input,
    value: () => valueOf(typedNumber(input.value)),
    problem: () => {
      const typed = typedNumber(input.value);
      return typed.text === null ? typed.problem : rangeProblem(item, valueOf(typed));
    },
  };
}

// As protocols/form.cpp takes it.
const maxCharacters = 5000;
const controlCharacters = /[\u0000-\u0008\u000b\u000c\u000e-\u001f\u007f-\u009f]/g;

function text(item, id) {
  const input = el("textarea", { id, rows: 3 });
  const typed = () => input.value.replace(controlCharacters, "");
  return {
    body: input,
    value: () => (typed().trim() === "" ? null : typed()),
    problem: () => ([...typed()].length > maxCharacters ? word("too_long", { max: maxCharacters }) : null),
  };
}

const makers = { likert, scale, number, single_choice: singleChoice, multiple_choice: multipleChoice, text };
const areLabelled = new Set(["number", "text"]);

function titleOf(item, id) {
  const notes = [
    item.kind === "multiple_choice" ? word("one_or_more") : null,
    item.is_required ? null : word("optional"),
  ].filter((note) => note !== null);
  const noted = notes.length === 0 ? null : el("span", { className: "note" }, ` (${notes.join(", ")})`);
  if (areLabelled.has(item.kind)) return el("label", { htmlFor: id, className: "question" }, item.question, noted);
  return el("legend", { className: "question" }, item.question, noted);
}

function clearButton(item, field) {
  if (item.is_required || !field.clear) return null;
  const spoken = `${word("clear")}: ${item.question}`;
  const clear = ({ target }) => {
    field.clear();
    target.dispatchEvent(new Event("input", { bubbles: true }));
  };
  return el("button", { type: "button", className: "quiet", "aria-label": spoken, onclick: clear }, word("clear"));
}

export function formItem(item, id) {
  const field = makers[item.kind](item, id);
  const error = el("p", { className: "error", id: `${id}-error` });
  const element = el(areLabelled.has(item.kind) ? "div" : "fieldset", { className: `item ${item.kind}` },
    titleOf(item, id), pictureOf(item.picture), field.body, error, clearButton(item, field));
  element.dataset.name = item.name;
  const inputs = element.querySelectorAll("input, textarea");
  inputs.forEach((input) => input.setAttribute("aria-describedby", error.id));

  function show(problem) {
    error.textContent = problem ?? "";
    element.classList.toggle("is-wrong", problem !== null);
    inputs.forEach((input) => {
      if (input.type !== "radio" && input.type !== "checkbox") input.setAttribute("aria-invalid", String(problem !== null));
    });
  }
  function check() {
    const missing = item.is_required && field.value() === null ? word("answer_needed") : null;
    const problem = field.problem?.() ?? missing;
    show(problem);
    return problem === null;
  }
  // At once: on leaving a field the page would move under the press that follows.
  element.addEventListener("input", () => { if (error.textContent) check(); });
  const isAnswered = (answers) => {
    const value = String(field.value());
    return [value, ...value.split(betweenChoices)].some((choice) => answers.includes(choice));
  };
  return {
    name: item.name,
    askedIf: item.asked_if,
    element,
    value: field.value,
    isAnswered,
    endsSession: () => isAnswered(item.ends_session),
    check,
    focus: () => inputs[0].focus(),
  };
}
