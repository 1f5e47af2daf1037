// A trial: which option is this, or which of several alternatives to feel is the right one.

import { el } from "./dom.js";
import { question } from "./question.js";
import { newGroupName, pickNumber, radioCard } from "./radio_cards.js";
import { word } from "./words.js";

function optionCards(options) {
  const group = newGroupName();
  const cards = options.map((label, index) =>
    radioCard({ group, value: index, label, key: index < 9 ? String(index + 1) : null }));
  return el("div", { className: "options" }, ...cards);
}

const letterOf = (label, index) =>
  /^[a-z]$/i.test(label) ? label.toLowerCase() : String.fromCharCode("a".charCodeAt(0) + index);

// option: what choosing it answers; negative: it cannot be chosen, only felt.
function alternativeCard({ label, index, option, group, feel }) {
  const button = el("button", { type: "button", className: "feel", "aria-pressed": "false", onclick: () => feel(index) },
    el("span", {}, word("feel", { label })));
  if (option < 0) return el("div", { className: "alternative only-felt" }, button);
  const choose = radioCard({
    group, value: option, label: word("this_one"), key: option < 9 ? String(option + 1) : null,
    spokenLabel: `${word("this_one")}: ${label}`,
  });
  return el("div", { className: "alternative" }, button, choose);
}

function hint(labels) {
  const keys = labels.map((label, index) => letterOf(label, index).toUpperCase()).join(", ");
  return el("p", { className: "hint" }, word("feel_hint"), " ",
    el("span", { className: "keys" }, word("feel_keys", { keys })));
}

function alternativeCards(labels, options, feel) {
  const group = newGroupName();
  const cards = labels.map((label, index) =>
    alternativeCard({ label, index, option: options.indexOf(label), group, feel }));
  return el("div", { className: "alternatives" }, ...cards);
}

function showCurrent(element, current) {
  element.querySelectorAll(".feel").forEach((button, index) => {
    button.setAttribute("aria-pressed", String(index === current));
  });
}

// The last answer, as long as it may be corrected.
function lastAnswer(labels, correct) {
  const buttons = labels.map((label, index) =>
    el("button", { type: "button", onclick: () => correct(index) }, label));
  return el("details", { className: "previous" },
    el("summary", {}, word("correct_last")),
    el("p", { className: "hint" }, word("correct_last_hint")),
    el("div", { className: "options" }, ...buttons));
}

export function trialScreen({ trial }, { send, feel, correct, say }) {
  const labels = trial.alternatives ?? [];
  let current = trial.current;
  const feelOther = (index) => { if (index !== current) feel(index); };
  const beside = labels.includes(trial.options[0]) ? [] : [optionCards(trial.options)];
  const asked = question({
    title: trial.question,
    className: "trial",
    body: labels.length > 0
      ? [hint(labels), alternativeCards(labels, trial.options, feelOther), ...beside]
      : [optionCards(trial.options)],
    say,
    send: (value) => send("answer", Number(value)),
  });
  if (trial.previous) asked.element.append(lastAnswer(trial.previous, correct));
  showCurrent(asked.element, current);

  function press(key) {
    const index = labels.findIndex((label, at) => letterOf(label, at) === key.toLowerCase());
    if (index < 0) return pickNumber(asked.element, key);
    feelOther(index);
    return true;
  }
  function update(screen) {
    current = screen.trial.current;
    if (!screen.trial.correction) return showCurrent(asked.element, current);
    asked.element.querySelector(".previous")?.removeAttribute("open");
    say(word(`correction_${screen.trial.correction}`));
    showCurrent(asked.element, current);
  }
  return { ...asked, press, update };
}
