#include "core/text/plain_text.hpp"

#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;

TEST_CASE("text is what Python decodes as UTF-8 and has no control characters", "[core]") {
  std::vector<double> ours;
  std::string script =
      "import itertools\nb = bytes([0,0x1f,0x7f,0x80,0x9f,0xa0,0xbf,0xc0,0xc2,0xdf,"
      "0xe0,0xed,0xef,0xf0,0xf4,0xf5,0xff,0x61,0x41])\n"
      "def plain(t):\n"
      "  try: s = bytes(t).decode('utf-8')\n"
      "  except UnicodeDecodeError: return 0\n"
      "  return int(not any(ord(c) < 32 or 127 <= ord(c) < 160 for c in s))\n"
      "out(*[plain(t) for n in range(1, 5) for t in itertools.product(b, repeat=n)])\n";
  const std::string alphabet{
      "\x00\x1f\x7f\x80\x9f\xa0\xbf\xc0\xc2\xdf\xe0\xed\xef\xf0\xf4\xf5\xff\x61\x41", 19};
  for (std::size_t length = 1; length <= 4; ++length) {
    std::vector<std::size_t> at(length, 0);
    while (true) {
      std::string text;
      for (const std::size_t i : at) {
        text += alphabet[i];
      }
      ours.push_back(core::is_plain_text(text) ? 1.0 : 0.0);
      std::size_t place = length;
      while (place > 0 && ++at[place - 1] == alphabet.size()) {
        at[--place] = 0;
      }
      if (place == 0) {
        break;
      }
    }
  }
  CHECK(ours == testing::python_numbers(script));
  CHECK(core::is_plain_text("two\nlines\tand ünicode \xf0\x9f\x8d\x8e"));
}

TEST_CASE("blanks are trimmed at the ends, not within", "[core]") {
  CHECK(core::trimmed(" \t a  b\r\n") == "a  b");
  CHECK(core::trimmed("ü") == "ü");
  CHECK(core::trimmed(" \n").empty());
  CHECK(core::trimmed("").empty());
}

TEST_CASE("text is cut between characters, never in one", "[core]") {
  const std::string apple = "\xf0\x9f\x8d\x8e";
  const std::string text = "ü" + apple + "b";
  CHECK(core::character_count(text) == 3);
  const std::vector<std::string> by_bytes{"", "", "ü", "ü", "ü", "ü", "ü" + apple, text, text};
  for (std::size_t bytes = 0; bytes < by_bytes.size(); ++bytes) {
    CHECK(core::cut_to(text, bytes) == by_bytes[bytes]);
    CHECK(core::is_plain_text(core::cut_to(text, bytes)));
  }
  CHECK(core::shortened(text, 3) == "ü…");
  CHECK(core::shortened(text, 7) == text);
}
