#pragma once
#include <optional>
#include <string>
#include <vector>

#include "protocols/form.hpp"
namespace tapstudy::protocols {
// How an answer is given.
//   option  one of the options
//   number  any number above 0
//   setting where the last alternative was set to: the place of its setting, from 1
//   order   all options, the first of the order first
//   line    a mark on a line, from 0 to 1
enum class AnswerKind { option, number, setting, order, line };

// What the ends of a scale mean.
struct ScaleEnds {
  std::string low;
  std::string high;
};

// The answers that a trial takes. Each is given as a text, the same at the terminal, from a page
// and in a correction.
struct Answers {
  AnswerKind kind{AnswerKind::option};
  std::vector<Option> options{};
  std::optional<std::size_t> judged{};  // the alternative that all answers are about
  std::size_t settings{};               // how many there are
  std::optional<double> modulus{};      // the number of the first alternative, as people are told
  ScaleEnds ends{};                     // of a line, or where the options are steps of a scale
  std::vector<std::string> keys{};      // of the options, small letters; empty: their places alone
};

// A decimal comma as a point; "1,000" stays, which may be a thousand and is no number then.
std::string with_decimal_point(std::string text);
// The name of the option with this key, a letter in either case; nullopt: it is no key.
std::optional<std::string> option_of_key(const std::string& text, const Answers& answers);
// The key or the place by which an option is answered, as people are told.
std::string key_of_option(std::size_t option, const Answers& answers);
// The answer that a text gives: an option's name where the text is its key or place, from 1; a
// number above 0 in decimal notation, at most 20 characters, in its shortest form; a setting's
// place; a mark from 0 to 1, written likewise; all options' names with a space between, where the
// text has all their places, with spaces or commas between. Spaces around it do not matter.
// nullopt: the text is no answer.
std::optional<std::string> answer_in(const std::string& text, const Answers& answers);
// What answer_in takes: "a number from 1 to 4".
std::string expected_answer(const Answers& answers);
// The names in an answer that is an order.
std::vector<std::string> names_in_order(const std::string& answer);
// An answer as people read it: an option's label, of an order all.
std::string label_of_answer(const std::string& answer, const Answers& answers);
}  // namespace tapstudy::protocols
