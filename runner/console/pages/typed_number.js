// Numbers as people type them, with the decimal mark of the page's language or the other one, and in
// full width as input methods give them.

import { word } from "./words.js";

const isDecimal = (text) => /^[+-]?(\d+\.?\d*|\.\d+)$/.test(text);

// text: with a point; problem: words for what is not taken, or null; mayBeThousands: why it is not.
// What is a thousand in one language and a fraction in another is not taken for either: "1,000" where
// fractions have a point, "1.000" where they have a comma.
export function typedNumber(typed) {
  const text = typed.normalize("NFKC").trim();
  const mark = word("decimal_mark");
  const other = mark === "," ? "\\." : ",";
  if (new RegExp(`^[+-]?[1-9]\\d{0,2}${other}\\d{3}$`).test(text)) {
    const digits = text.replace(/[.,]/, "");
    const fraction = text.replace(/[.,]/, mark).replace(/0+$/, "").replace(/[.,]$/, "");
    return { text: null, problem: word("maybe_thousands", { text, digits, fraction }), mayBeThousands: true };
  }
  const withPoint = text.replace(",", ".");
  return isDecimal(withPoint) ? { text: withPoint, problem: null } : { text: null, problem: text === "" ? null : word("not_a_number") };
}
