// How sure the participant is of the answer just given.

import { question } from "./question.js";
import { pickNumber, steps } from "./radio_cards.js";
import { word } from "./words.js";

export function confidenceScreen({ confidence }, { send, say }) {
  const scale = steps({ count: confidence.steps, low: confidence.low, high: confidence.high });
  const asked = question({
    title: word("confidence_question"),
    className: "confidence",
    body: [scale],
    say,
    send: (value) => send("confidence", Number(value)),
  });
  return { ...asked, press: (key) => pickNumber(asked.element, key) };
}
