// The participant's page: shows one screen at a time and sends what the participant does.

import { listen, post, sayAlive } from "./connection.js";
import { byId, setText } from "./dom.js";
import { Outbox } from "./outbox.js";
import { EnteredAnswer } from "./entered_answer.js";
import { formScreen } from "./screen_form.js";
import { confidenceScreen } from "./screen_confidence.js";
import { restScreen, textScreen } from "./screen_text.js";
import { trialScreen } from "./screen_trial.js";
import { View } from "./view.js";
import { loadWords, SessionTime, setLanguage, word } from "./words.js";

const makers = {
  wait: textScreen, instructions: textScreen, message: textScreen, feedback: textScreen,
  paused: textScreen, ended: textScreen, rest: restScreen, trial: trialScreen,
  confidence: confidenceScreen, form: formScreen,
};

// A press meant for the last screen must not act on the next one.
const settleMs = 250;

let screen = null;
let shown = null;
let enteredAnswer = null;
let notice = "";

// Why an answer was too early.
function noticeText(why) {
  if (!why) return "";
  const times = why.reason !== "time" && why.contacts > 1 ? "_times" : "";
  return word(`notice_${why.reason}${times}`, { ...why, labels: why.labels.join(", ") });
}
let view = null;
const outbox = new Outbox(setBusy, say);

let saying = null;
function say(text) {
  const status = byId("status");
  clearTimeout(saying);
  // The same words again are announced again only if they went away in between.
  status.textContent = "";
  if (text) saying = setTimeout(() => setText(status, text), 50);
}

function setBusy(isBusy) {
  byId("panel").setAttribute("aria-busy", String(isBusy));
}

const send = (action, value) => outbox.send({ screen: screen.number, action, value });

// What is neither an answer nor waits for one. A press that crossed a new screen of the same trial
// is sent once more, as soon as that screen is here.
async function screenAfter(number) {
  for (let waits = 0; waits < 20 && screen.number === number; waits += 1) {
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
async function actBeside(action, value, failed) {
  const input = () => ({ screen: screen.number, action, value });
  const before = shown;
  try {
    const first = input();
    let verdict = await post(first);
    if (!verdict.accepted) await screenAfter(first.screen);
    if (!verdict.accepted && shown === before && screen.number !== first.screen) verdict = await post(input());
    if (!verdict.accepted && shown === before) say(word("not_accepted", { why: verdict.why ?? "" }));
    return verdict.accepted;
  } catch {
    say(word(failed));
    return false;
  }
}
const feel = (alternative) => actBeside("switch", alternative, "not_switched");
const replay = () => actBeside("replay_intervals", null, "not_switched");
const adjust = (setting) => actBeside("adjust", setting, "not_switched");
const correct = (text) => actBeside("correct", text, "correction_failed");

function identity({ kind, number, trial }) {
  if (kind === "trial") return JSON.stringify([kind, trial.number, trial.question, trial.answers, trial.alternatives]);
  return JSON.stringify([kind, number]);
}

function showProgress(progress) {
  byId("progress").hidden = !progress;
  if (!progress) return;
  const bar = byId("progress").querySelector("progress");
  bar.hidden = progress.is_open_ended;
  bar.max = Math.max(progress.total, 1);
  bar.value = progress.done;
  const words = progress.is_practice ? "progress_practice" : "progress";
  setText(byId("progress-text"), word(progress.is_open_ended ? `${words}_open` : words, progress));
  time.note(progress, screen.kind === "ended");
  setText(byId("time-text"), time.text());
}
const time = new SessionTime(() => showProgress(screen.progress));

let settling = null;
function settle() {
  delete document.body.dataset.settled;
  clearTimeout(settling);
  settling = setTimeout(() => { document.body.dataset.settled = "true"; }, settleMs);
}

function mount(key) {
  shown?.leave?.();
  enteredAnswer?.leave();
  enteredAnswer = new EnteredAnswer(() => screen.number);
  const entered = (answer) => enteredAnswer.tell(answer);
  // Should the next one not be drawn, the last one must not stand for it.
  shown = null;
  byId("screen").replaceChildren();
  shown = (makers[screen.kind] ?? textScreen)(screen, { send, entered, feel, adjust, replay, correct, say });
  shown.key = key;
  byId("screen").replaceChildren(shown.element);
  window.scrollTo(0, 0);
  shown.element.querySelector("h1")?.focus({ preventScroll: true });
  settle();
}

// A notice that came again is said again. It stays as long as intervals go on by themselves.
function showNotice(isNewScreen) {
  const text = noticeText(screen.trial?.notice);
  const isBetween = ["gap", "leaving", "open"].includes(screen.trial?.intervals?.phase);
  if (isBetween && !isNewScreen && !text) return;
  if (isNewScreen || text || notice) say(text);
  notice = text;
}

function showScreen(next) {
  const isRepeated = screen?.number === next.number && shown?.language === next.language;
  screen = next;
  outbox.screenArrived(next.number);
  setLanguage(next.language);
  document.title = next.title;
  setText(byId("study"), next.title);
  showProgress(next.progress);
  document.body.dataset.kind = next.kind;
  document.body.dataset.screen = next.number;
  view.show(next.scene ?? null);
  const key = identity(next);
  const isNew = shown?.key !== key || shown.language !== next.language;
  if (isNew) mount(key);
  shown.language = next.language;
  if (!isNew) shown.update?.(next);
  if (!isRepeated) showNotice(isNew);
}

function pressed(event) {
  const { target, key } = event;
  if (event.repeat || event.isComposing || event.ctrlKey || event.altKey || event.metaKey) return;
  if (!document.body.dataset.settled || !shown) return;
  // Keys in a field are its own, and those in a correction do not answer this trial.
  if (target.closest("textarea, input[type=text], input[type=number], .previous")) return;
  const isHandled = key === "Enter" ? !target.closest("button") && shown.submit?.() : shown.press?.(key);
  if (isHandled) event.preventDefault();
}

function stopWhatCameTooEarly(event) {
  if (document.body.dataset.settled) return;
  event.preventDefault();
  event.stopPropagation();
}

async function start() {
  await loadWords();
  const isPlanWanted = new URLSearchParams(location.search).get("view") === "plan";
  view = new View(byId("view"), isPlanWanted);
  byId("panel").addEventListener("click", stopWhatCameTooEarly, true);
  document.addEventListener("keydown", pressed);
  sayAlive(() => screen?.kind === "ended");
  listen({ screen: showScreen, hand: (hand) => view.moveHand(hand) }, () => screen?.kind === "ended");
}

start();
