// A trial: which option is this, or which of several alternatives to feel is the right one.

import { answerField, cardOf, otherAnswer } from "./answer_fields.js";
import { countdown } from "./countdown.js";
import { el } from "./dom.js";
import { goSignal, intervalCard, showInterval } from "./intervals.js";
import { question } from "./question.js";
import { newGroupName } from "./radio_cards.js";
import { word } from "./words.js";

const letterOf = (label, index) =>
  /^[a-z]$/i.test(label) ? label.toLowerCase() : String.fromCharCode("a".charCodeAt(0) + index);

// option: what choosing it answers; negative: it cannot be chosen, only felt.
function alternativeCard({ label, index, option, group, keys, feel }) {
  const button = el("button", { type: "button", className: "feel", "aria-pressed": "false", onclick: () => feel(index) },
    el("span", {}, word("feel", { label })));
  if (option < 0) return el("div", { className: "alternative only-felt" }, button);
  const choose = cardOf({ group, option, label, keys });
  return el("div", { className: "alternative" }, button, choose);
}

const hints = { option: "feel_hint", number: "feel_hint_number", setting: "feel_hint_setting", order: "feel_hint_order" };

function hint(labels, { kind, modulus }) {
  const keys = labels.map((label, index) => letterOf(label, index).toUpperCase()).join(", ");
  const told = modulus === null ? "" : ` ${word("modulus", { label: labels[0], number: modulus })}`;
  return el("p", { className: "hint" }, word(hints[kind], { label: labels.at(-1) }), told, " ",
    el("span", { className: "keys" }, word("feel_keys", { keys }), kind === "setting" ? ` ${word("setting_keys", { label: labels.at(-1) })}` : ""));
}

function alternativeCards(labels, { kind, options, keys }, group, makeCard) {
  const optionOf = (label) => (kind === "option" ? options.indexOf(label) : -1);
  const cards = labels.map((label, index) => makeCard({ label, index, option: optionOf(label), group, keys }));
  return el("div", { className: "alternatives" }, ...cards);
}

// A single one needs nothing to be felt by.
const alone = { body: [], show: () => {} };

// Freely: a button to feel each of them.
function freely({ trial, group, feel }) {
  const labels = trial.alternatives;
  const cards = alternativeCards(labels, trial.answers, group, (card) => alternativeCard({ ...card, feel }));
  return { body: [hint(labels, trial.answers), cards], show: showCurrent };
}

function showCurrent(element, { current }) {
  element.querySelectorAll(".feel").forEach((button, index) => {
    button.setAttribute("aria-pressed", String(index === current));
  });
}

// One after the other, by themselves.
function inTurn({ trial, group, replay }) {
  const cards = alternativeCards(trial.alternatives, trial.answers, group, intervalCard);
  return { body: [goSignal(replay), cards], show: showInterval };
}

// Where taps are scripted.
function toHoldStill({ is_tapped_by_script: isScripted }) {
  return isScripted ? [el("p", { className: "hint" }, word("hold_still"))] : [];
}

// Where an answer must come within a time; it is told anew with each update of the screen.
function deadline({ seconds_left: seconds }) {
  if (seconds === null) return { body: [], show: () => {}, leave: () => {} };
  const element = el("p", { className: "hint countdown", role: "timer" });
  let left = countdown(seconds);
  const tick = () => { element.textContent = word("time_left", { seconds: left() }); };
  const timer = setInterval(tick, 200);
  tick();
  const show = ({ seconds_left: now }) => { left = countdown(now); };
  return { body: [element], show, leave: () => clearInterval(timer) };
}

// The last answer, as long as it may be corrected.
function lastAnswer(answers, say, correct) {
  const element = el("details", { className: "previous" },
    el("summary", {}, word("correct_last")),
    el("p", { className: "hint" }, word("correct_last_hint")),
    ...otherAnswer(answers, say, correct));
  // Enter in a field would send the form around it: the answer of this trial.
  element.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && event.target.matches("input")) event.preventDefault();
  });
  return element;
}

export function trialScreen({ trial }, { send, entered, feel, adjust, replay, correct, say }) {
  const labels = trial.alternatives ?? [];
  let { current } = trial;
  const feelOther = (index) => { if (index !== current) feel(index); };
  const { answers } = trial;
  const group = newGroupName();
  const presented = labels.length === 0 ? alone : trial.intervals ? inTurn({ trial, group, replay }) : freely({ trial, group, feel: feelOther });
  const field = answerField(answers, {
    title: trial.question, besideAlternatives: answers.options.filter((option) => labels.includes(option)).length,
    group, label: labels.at(-1), setting: trial.setting, adjust, say,
  });
  const limit = deadline(trial);
  const asked = question({
    title: trial.question,
    className: "trial",
    body: [...limit.body, ...toHoldStill(trial), ...presented.body, ...field.body],
    say,
    answerIn: field.answerIn,
    missing: field.missing,
    label: word(trial.asks_confidence ? "go_on" : "confirm"),
    entered: answers.kind === "setting" ? () => {} : entered,  // a setting is an event of its own
    send: (value) => send("answer", value),
  });
  if (trial.previous) asked.element.append(lastAnswer(trial.previous, say, correct));
  presented.show(asked.element, trial);

  function press(key) {
    const index = labels.findIndex((label, at) => letterOf(label, at) === key.toLowerCase());
    if (index < 0 || trial.intervals) return field.press(asked.element, key);
    feelOther(index);
    return true;
  }
  asked.element.querySelector("#number-answer")?.addEventListener("keydown", (event) => {
    if (/^[a-z]$/i.test(event.key) && !event.ctrlKey && !event.metaKey && press(event.key)) event.preventDefault();
  });
  function update(screen) {
    current = screen.trial.current;
    field.update?.(screen.trial.setting);
    limit.show(screen.trial);
    if (screen.trial.correction) {
      asked.element.querySelector(".previous")?.removeAttribute("open");
      say(word(`correction_${screen.trial.correction}`));
    }
    presented.show(asked.element, screen.trial);
  }
  return { ...asked, press, update, leave: limit.leave };
}
