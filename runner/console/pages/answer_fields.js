// What a trial's answers are given by: cards to pick one of the options, or a field for a number.
// The text that is sent is what would be typed at the terminal: an option's place, or the number.

import { el } from "./dom.js";
import { newGroupName, pickedValue, pickNumber, radioCard } from "./radio_cards.js";
import { word } from "./words.js";

const placeOf = (index) => String(index + 1);

function optionCards(options) {
  const group = newGroupName();
  const cards = options.map((label, index) =>
    radioCard({ group, value: placeOf(index), label, key: index < 9 ? placeOf(index) : null }));
  return el("div", { className: "options" }, ...cards);
}

// A card that stands beside its alternative.
export const cardOf = ({ group, option, label }) => radioCard({
  group, value: placeOf(option), label: word("this_one"), key: option < 9 ? placeOf(option) : null,
  spokenLabel: `${word("this_one")}: ${label}`,
});

// isBesideAlternatives: the options stand there already.
function optionField({ options }, isBesideAlternatives) {
  return {
    body: isBesideAlternatives ? [] : [optionCards(options)],
    answerIn: pickedValue,
    missing: word("pick_first"),
    press: (element, key) => pickNumber(element, key),
  };
}

const isNumberAbove0 = (text) =>
  text.length <= 20 && /^(\d+\.?\d*|\.\d+)$/.test(text) && Number(text) > 0 && Number.isFinite(Number(text));

const numberInput = (id) =>
  el("input", { type: "text", id, className: "number-answer", inputMode: "decimal", autocomplete: "off", maxLength: 40 });

const numberIn = (input) => (isNumberAbove0(input.value.trim()) ? input.value.trim() : null);

// Digits go to the field from anywhere; letters in it are no part of a number and feel an alternative.
function numberField() {
  const input = numberInput("number-answer");
  return {
    body: [el("label", { htmlFor: input.id, className: "number-label" }, word("number_label")), input],
    answerIn: () => numberIn(input),
    missing: word("number_needed"),
    press: (element, key) => {
      if (!/^[0-9.]$/.test(key)) return false;
      input.focus();
      input.value += key;
      input.dispatchEvent(new Event("input", { bubbles: true }));
      return true;
    },
  };
}

const makers = { option: optionField, number: numberField };

// {body, answerIn(element), missing, press(element, key)}
export const answerField = (answers, isBesideAlternatives) => makers[answers.kind](answers, isBesideAlternatives);

// Another answer instead of one that was given, sent by a button.
export function otherAnswer({ kind, options }, say, send) {
  if (kind === "option") {
    const buttons = options.map((label, index) =>
      el("button", { type: "button", onclick: () => send(placeOf(index)) }, label));
    return [el("div", { className: "options" }, ...buttons)];
  }
  const input = numberInput("number-correction");
  const give = () => {
    const value = numberIn(input);
    if (value === null) say(word("number_needed"));
    else send(value);
  };
  input.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    give();
  });
  return [el("label", { htmlFor: input.id, className: "number-label" }, word("number_label")),
    el("div", { className: "row" }, input, el("button", { type: "button", onclick: give }, word("confirm")))];
}
