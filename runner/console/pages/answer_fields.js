// What a trial's answers are given by: cards to pick one of the options, a field for a number,
// buttons that change an alternative, the options to be put in order, or a line to mark. The text that
// is sent is an option's place, the number, the setting's place, all options' places in order, or the
// mark from 0 to 1.

import { analogueScale } from "./analogue_scale.js";
import { el } from "./dom.js";
import { orderOf } from "./order_field.js";
import { newGroupName, pickedValue, pickNumber, radioCard, steps } from "./radio_cards.js";
import { typedNumber } from "./typed_number.js";
import { word } from "./words.js";

const placeOf = (index) => String(index + 1);

// The key that picks an option: the study's own, else its place where that is one digit.
const keyOf = (option, keys) => keys[option] ?? (option < 9 ? placeOf(option) : null);

function optionCards(options, keys, { group = newGroupName(), from = 0 } = {}) {
  const cards = options.slice(from).map((label, index) => {
    const option = from + index;
    return radioCard({ group, value: placeOf(option), label, key: keyOf(option, keys) });
  });
  return el("div", { className: "options" }, ...cards);
}

// A card that stands beside its alternative.
export const cardOf = ({ group, option, label, keys }) => radioCard({
  group, value: placeOf(option), label: word("this_one"), key: keyOf(option, keys),
  spokenLabel: `${word("this_one")}: ${label}`,
});

// The first so many options stand beside their alternatives already, in the same group.
function optionField({ options, keys, low, high }, { besideAlternatives, group }) {
  const isScale = Boolean(low || high);
  const cards = () => (isScale ? steps({ count: options.length, low, high, keys }) : optionCards(options, keys, { group, from: besideAlternatives }));
  const numberOf = (key) => (keys.length === 0 ? key : String(keys.indexOf(key.toLowerCase()) + 1));
  return {
    body: besideAlternatives < options.length ? [cards()] : [],
    answerIn: pickedValue,
    missing: word("pick_first"),
    press: (element, key) => pickNumber(element, numberOf(key)),
  };
}

const numberInput = (id) =>
  el("input", { type: "text", id, className: "number-answer", inputMode: "decimal", autocomplete: "off", maxLength: 40 });

const maxCharacters = 20;  // as protocols/tasks/answers.cpp takes it
const isAbove0 = (text) => text.length <= maxCharacters && Number(text) > 0 && Number.isFinite(Number(text));

// Above 0, without a sign.
function numberIn(input) {
  const { text } = typedNumber(input.value);
  return text !== null && /^[\d.]+$/.test(text) && isAbove0(text) ? text : null;
}
const numberProblem = (input) => {
  const { problem, mayBeThousands } = typedNumber(input.value);
  return mayBeThousands ? problem : word("number_needed");
};

// Digits go to the field from anywhere; letters in it are no part of a number and feel an alternative.
function numberField() {
  const input = numberInput("number-answer");
  return {
    body: [el("label", { htmlFor: input.id, className: "number-label" }, word("number_label")), input],
    answerIn: () => numberIn(input),
    missing: () => numberProblem(input),
    press: (element, key) => {
      if (!/^[0-9.,]$/.test(key)) return false;
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

// Dials that are keyboards turn the volume; those that are mice turn a wheel.
const keyNames = { "+": "ArrowUp", "-": "ArrowDown", AudioVolumeUp: "ArrowUp", AudioVolumeDown: "ArrowDown" };
const pixelsANotch = 100;
const notchesOf = ({ deltaY, deltaMode }) => (deltaMode === WheelEvent.DOM_DELTA_PIXEL ? deltaY / pixelsANotch : Math.sign(deltaY));

// Calls move with whole notches, positive upwards.
function onTurn(element, move) {
  let turned = 0;
  element.addEventListener("wheel", (event) => {
    event.preventDefault();
    turned -= notchesOf(event);
    const notches = Math.trunc(turned);
    turned -= notches;
    if (notches !== 0) move(notches);
  }, { passive: false });
  return element;
}

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
    body: [onTurn(el("div", { className: "moves" }, ...buttons), move)],
    answerIn: () => (wanted === shown ? String(shown + 1) : null),
    missing: word("please_wait"),
    press: (element, key) => {
      const wantedMove = moves.find((one) => one.key === (keyNames[key] ?? key));
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

const lineMoves = { ArrowLeft: -0.01, ArrowDown: -0.01, ArrowRight: 0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1 };

// Arrows move the mark from anywhere.
function lineField({ low, high }, { title }) {
  const scale = analogueScale({ low, high, label: title });
  const mark = () => (scale.value() === null ? null : String(scale.value()));
  return {
    body: [scale.body],
    answerIn: mark,
    missing: word("mark_first"),
    press: (element, key) => {
      if (!(key in lineMoves) || document.activeElement === scale.input) return false;
      scale.input.focus();
      scale.input.value = Number(scale.input.value) + lineMoves[key];
      scale.input.dispatchEvent(new Event("input", { bubbles: true }));
      return true;
    },
  };
}

const makers = { option: optionField, number: numberField, setting: settingField, order: orderField, line: lineField };

// {body, answerIn(element), missing (words, or what gives them), press(element, key)}, of a setting also update(setting).
// trial: {title, besideAlternatives, group, label, setting, adjust, say}
export const answerField = (answers, trial) => makers[answers.kind](answers, trial);

function otherMark({ low, high }, say, send) {
  const scale = analogueScale({ low, high, label: word("correct_last") });
  const give = () => (scale.value() === null ? say(word("mark_first")) : send(String(scale.value())));
  return [scale.body, el("button", { type: "button", onclick: give }, word("confirm"))];
}

// Another answer instead of one that was given, sent by a button.
export function otherAnswer(answers, say, send) {
  const { kind, options } = answers;
  if (kind === "line") return otherMark(answers, say, send);
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
    if (value === null) say(numberProblem(input));
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
