// Screens that are read, not answered: instructions, messages, rests, and what happens between.

import { countdown } from "./countdown.js";
import { el, pictureOf } from "./dom.js";
import { markedText } from "./marked_text.js";
import { word } from "./words.js";

const titles = {
  wait: "please_wait", instructions: "instructions", rest: "rest", paused: "paused",
  ended: "ended", message: "message", feedback: "feedback",
};
const ownTexts = { paused: "paused_text", ended: "ended_text", rest: "rest_text" };

function feedbackTitle({ is_correct: isCorrect }) {
  return word(isCorrect ? "feedback_correct" : "feedback_wrong");
}

function contentOf(screen) {
  if (screen.message) return { title: word(`message_${screen.message}`), body: [] };
  const { title, body } = markedText(screen.text);
  if (screen.kind === "feedback" && screen.feedback) {
    const right = el("p", { className: "right" }, word("feedback_right", { right: screen.feedback.right }));
    return { title: feedbackTitle(screen.feedback), body: [right, ...body] };
  }
  const isBare = body.length === 0 && !title && screen.kind in ownTexts;
  return {
    title: title ?? word(titles[screen.kind] ?? "please_wait"),
    body: isBare ? [el("p", {}, word(ownTexts[screen.kind]))] : body,
  };
}

function hasGoOn({ kind, can_go_on: canGoOn }) {
  if (kind === "instructions" || kind === "rest") return canGoOn !== false;
  return (kind === "message" || kind === "feedback") && canGoOn === true;
}

export function textScreen(screen, { send }) {
  const { title, body } = contentOf(screen);
  const goOn = hasGoOn(screen)
    ? el("button", { type: "button", className: "main", id: "go-on", onclick: () => send("go_on") }, word("go_on"))
    : null;
  const mark = screen.feedback ? (screen.feedback.is_correct ? " is-correct" : " is-wrong") : "";
  const element = el("article", { className: `text ${screen.kind}${mark}` },
    el("h1", { tabIndex: -1 }, title), ...body, pictureOf(screen.picture), goOn);
  return {
    element,
    goOn,
    submit() {
      if (!goOn || goOn.disabled) return false;
      goOn.click();
      return true;
    },
  };
}

export function restScreen(screen, actions) {
  const rest = textScreen(screen, actions);
  if (!rest.goOn) return rest;
  const minLeft = countdown(screen.min_seconds ?? 0);
  const isEndless = screen.max_seconds === null || screen.max_seconds === undefined;
  const maxLeft = countdown(screen.max_seconds ?? 0);
  const shown = el("p", { className: "countdown", id: "countdown" });
  rest.goOn.before(shown);
  let timer = null;

  function tick() {
    const left = minLeft();
    const isOver = rest.goOn.disabled && left <= 0;
    rest.goOn.disabled = left > 0;
    if (left > 0) {
      shown.textContent = word("rest_countdown", { seconds: left });
      return;
    }
    shown.textContent = isEndless ? "" : word("rest_ends", { seconds: maxLeft() });
    if (isOver && timer) actions.say(word("rest_over"));
    if (isEndless) clearInterval(timer);
  }
  rest.leave = () => clearInterval(timer);
  tick();
  if (rest.goOn.disabled || !isEndless) timer = setInterval(tick, 200);
  return rest;
}
