// What a trial's answers are given by: cards to pick one of the options, a field for a number,
// buttons that change an alternative, or the options to be put in order. The text that is sent is an
// option's place, the number, the setting's place, or all options' places in order.

import { el } from "./dom.js";
import { orderOf } from "./order_field.js";
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
function optionField({ options }, { isBesideAlternatives }) {
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

const farSteps = 5;
const moves = [
  { steps: -farSteps, name: "setting_far_down", key: "PageDown" }, { steps: -1, name: "setting_down", key: "ArrowDown" },
  { steps: 1, name: "setting_up", key: "ArrowUp" }, { steps: farSteps, name: "setting_far_up", key: "PageUp" },
];

// Buttons that move an alternative among its settings. Where it stands is not shown: it is to be felt.
function settingField({ settings }, { label, setting, adjust, say }) {
  let shown = setting;
  let wanted = setting;
  let isSending = false;
  async function sendWanted() {
    if (isSending) return;
    isSending = true;
    let sent;
    do {
      sent = wanted;
      if (!await adjust(sent)) wanted = sent = shown;
    } while (wanted !== sent);
    isSending = false;
  }
  function move(steps) {
    const to = Math.min(settings - 1, Math.max(0, wanted + steps));
    if (to === wanted) return say(word("no_further", { label }));
    wanted = to;
    return sendWanted();
  }
  const buttons = moves.map(({ steps, name }) =>
    el("button", { type: "button", className: "move", onclick: () => move(steps), "aria-label": word(`${name}_spoken`, { label }) },
      word(name, { label })));
  return {
    body: [el("div", { className: "moves" }, ...buttons)],
    answerIn: () => (wanted === shown ? String(shown + 1) : null),
    missing: word("please_wait"),
    press: (element, key) => {
      const wantedMove = moves.find((one) => one.key === key || (one.name === "setting_up" && key === "+") ||
        (one.name === "setting_down" && key === "-"));
      if (wantedMove) move(wantedMove.steps);
      return Boolean(wantedMove);
    },
    update: (now) => {
      shown = now;
      if (!isSending) wanted = now;
    },
  };
}

function orderField({ options }) {
  const order = orderOf(options);
  return {
    body: order.body,
    answerIn: order.answer,
    missing: word("order_incomplete"),
    press: (element, key) => {
      const isPlace = /^[1-9]$/.test(key) && Number(key) <= options.length;
      if (isPlace) order.toggle(Number(key) - 1);
      return isPlace;
    },
  };
}

const makers = { option: optionField, number: numberField, setting: settingField, order: orderField };

// {body, answerIn(element), missing, press(element, key)}, of a setting also update(setting).
// trial: {isBesideAlternatives, label, setting, adjust, say}
export const answerField = (answers, trial) => makers[answers.kind](answers, trial);

// Another answer instead of one that was given, sent by a button.
export function otherAnswer({ kind, options }, say, send) {
  if (kind === "option") {
    const buttons = options.map((label, index) =>
      el("button", { type: "button", onclick: () => send(placeOf(index)) }, label));
    return [el("div", { className: "options" }, ...buttons)];
  }
  if (kind === "order") {
    const order = orderOf(options);
    const give = () => (order.answer() === null ? say(word("order_incomplete")) : send(order.answer()));
    return [...order.body, el("button", { type: "button", onclick: give }, word("confirm"))];
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
