// The parts of the operator's page that only show the state.

import { byId, el, setText, showIfChanged } from "./dom.js";
import { word, wordOr } from "./words.js";

const row = (title, ...content) => [el("dt", {}, title), el("dd", {}, ...content)];

// Numbers are those of the store, practice included.
function trialLine({ trial }) {
  const { number, total, attempt, is_practice: isPractice } = trial;
  const parts = [word("trial_number", { number, total })];
  if (isPractice) parts.push(word("practice"));
  if (attempt > 1) parts.push(word("attempt", { attempt }));
  return parts.join(" · ");
}

function alternativeRow({ label, stimulus }, index, { current, number }, actions) {
  const name = [label, stimulus].filter(Boolean).join(": ");
  const isCurrent = index === current;
  const button = el("button", { type: "button", onclick: () => actions.send(`switch @${number} ${index + 1}`, word("action_switch")) },
    word("switch_to", { label }));
  button.dataset.action = "switch";
  button.dataset.isDone = String(isCurrent);
  button.disabled = isCurrent || !actions.isPossible("switch");
  const mark = isCurrent ? el("strong", { className: "current" }, `● ${word("rendered_now")}`) : button;
  return el("li", {}, el("span", {}, name), mark);
}

export function showTrial(state, actions) {
  const hasSwitch = (state.actions ?? []).some(({ name }) => name === "switch");
  const content = [state.trial, hasSwitch];
  showIfChanged(byId("trial").querySelector("div"), content, () => {
    const { trial } = state;
    if (!trial) return [el("p", { className: "muted" }, word("trial_none"))];
    const alternatives = trial.alternatives ?? [];
    return [
      el("p", { className: "trial-number" }, trialLine(state)),
      el("dl", {},
        ...(trial.block ? row(word("block"), trial.block) : []),
        ...row(word("question"), trial.question),
        ...(trial.answers?.options.length ? row(word("options"), trial.answers.options.join(" · ")) : [])),
      ...(alternatives.length
        ? [el("h3", {}, word("alternatives")),
          el("ul", { className: "plain" }, ...alternatives.map((one, index) => alternativeRow(one, index, trial, actions)))]
        : []),
    ];
  });
}

function correctionField({ kind, options }) {
  if (kind !== "option") return el("input", { type: "text", id: "correct-to", autocomplete: "off" });
  const isNumbered = (label, place) => label === place || label.startsWith(`${place} `);
  return el("select", { id: "correct-to" }, el("option", { value: "" }, "–"),
    ...options.map((label, index) => {
      const place = String(index + 1);
      return el("option", { value: place }, isNumbered(label, place) ? label : `${place} ${label}`);
    }));
}

function correction({ number, answers }, actions) {
  const field = correctionField(answers);
  const button = el("button", { type: "button", onclick: () => actions.send(`correct @${number} ${field.value.trim()}`, word("action_correct")) },
    word("correct_do"));
  button.dataset.action = "correct";
  // Nothing is corrected by a press that was meant for something else.
  const setPossible = () => {
    button.dataset.isDone = String(field.value.trim() === "");
    actions.enable(button);
  };
  for (const type of ["input", "change"]) field.addEventListener(type, setPossible);
  setPossible();
  return [el("label", { htmlFor: "correct-to" }, word("correct_to")), el("div", { className: "row" }, field, button)];
}

export function showLastAnswer(state, actions) {
  const hasCorrection = (state.actions ?? []).some(({ name }) => name === "correct");
  const content = [state.last_answer, hasCorrection];
  showIfChanged(byId("last").querySelector("div"), content, () => {
    const answer = state.last_answer;
    if (!answer) return [el("p", { className: "muted" }, word("last_none"))];
    const response = answer.response ?? word("response_hidden");
    return [
      el("p", { className: "last-line" }, word("last_line", { number: answer.number, response })),
      ...(hasCorrection ? correction(answer, actions) : []),
    ];
  });
}

export function showMachine(state) {
  const { ticks, masking } = state;
  const content = [state.device, state.participant_page, ticks, masking];
  showIfChanged(byId("machine").querySelector("dl"), content, () => [
    ...row(word("device"), state.device ?? "–"),
    ...row(word("participant_page"), state.participant_page
      ? word("page_open") : el("strong", { className: "bad" }, word("page_closed"))),
    ...(ticks ? row(word("ticks"), word("ticks_line", ticks)) : []),
    ...(masking ? row(word("masking"), word(masking.is_playing ? "masking_playing" : "masking_silent", { level: masking.level_db_fs })) : []),
    ...(masking ? row(word("underruns"), String(masking.underruns)) : []),
  ]);
}

function logEntry({ t_s: time, action, text, is_stored: isStored }) {
  return el("li", {},
    el("span", { className: "time" }, `${time.toFixed(1)} s`), " ",
    el("strong", {}, wordOr(`action_${action}`, action).replace(/\s*…$/, "")), " ",
    text ?? "",
    isStored === false ? el("em", { className: "bad" }, ` (${word("not_stored")})`) : null);
}

// Adds only what is new, so that a screen reader reads only that.
export function showLog(log) {
  const list = byId("log").querySelector("ol");
  const keys = log.map((entry) => JSON.stringify(entry));
  const shown = [...list.children].map((item) => item.dataset.key);
  const isContinued = shown.every((key, index) => key === keys[index]) && !list.querySelector(".muted");
  const frame = list.parentElement;
  const wasAtEnd = frame.scrollHeight - frame.scrollTop - frame.clientHeight < 8;
  if (!isContinued) list.replaceChildren();
  log.slice(list.children.length).forEach((entry) => {
    const item = logEntry(entry);
    item.dataset.key = JSON.stringify(entry);
    list.append(item);
  });
  if (log.length === 0) list.replaceChildren(el("li", { className: "muted" }, word("log_empty")));
  if (wasAtEnd) frame.scrollTop = frame.scrollHeight;
}
