#include "protocols/yaml/changed_texts.hpp"

#include "protocols/reader/read_protocol.hpp"
#include "support/blocks.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
std::string every_key_file() {
  return testing::source("tests/data/every_key.yaml");
}
std::string every_key_text() {
  return testing::contents(every_key_file());
}

protocols::ChangesOfFile changes(const std::string& before, const std::string& now) {
  const auto earlier = protocols::parse_protocol(before, every_key_file());
  const auto later = protocols::parse_protocol(now, every_key_file());
  return protocols::changes_between({earlier.text, earlier.translations},
                                    {later.text, later.translations});
}

struct Change {
  const char* what;
  const char* by;
  const char* key;  // that is told
};
}  // namespace

// What people read, and nothing of what is presented, asked for or stored.
TEST_CASE("wording, labels, instructions, notes, translations and the planned number are no data",
          "[protocols][texts]") {
  const auto [what, by, key] = GENERATE(
      Change{"First some practice.", "First, some practice.", "blocks[0].instructions"},
      Change{"participants: 12\n", "participants: 20\n", "participants"},
      Change{"participants: 12\n", "", "participants"},
      Change{"low: guessed", "low: a guess", "blocks[0].confidence.low"},
      Change{"{en: \"Which material?\", ja", "{en: \"Of what?\", ja", "blocks[1].question.en"},
      Change{"ja: 木質繊維板", "ja: 木", "blocks[1].response_labels.mdf.ja"},
      Change{"response_labels: {mdf: {en: wood fibre, ja: 木質繊維板}}\n", "\n",
             "blocks[1].response_labels.mdf.en"},
      Change{"{label: first, plate", "{plate", "stimuli.a.label"},
      Change{"  d:\n", "  d:\n    label: fourth\n", "stimuli.d.label"},
      Change{"title: The plates", "title: These plates", "forms.rating.title"},
      Change{"options: [left, right]", "options: [{en: left, de: links}, right]",
             "forms.about.items[1].options[0].en"},
      Change{"tie: {en: neither", "tie: {en: no difference", "blocks[12].tie.en"});
  const auto found = changes(every_key_text(), testing::replaced(every_key_text(), what, by));
  CHECK(found.data_keys == testing::Names{});
  REQUIRE_FALSE(found.texts.empty());
  CHECK(found.texts.front().key == key);
}

TEST_CASE("what can be answered, presented or stored is data, whatever its words are",
          "[protocols][texts]") {
  const auto [what, by, key] = GENERATE(
      Change{"options: [left, right], option_pictures: [{file: plates.svg, text: A left hand}, "
             "{file: plates.svg, text: A right hand}], ends_session: [left]",
             "options: [lefty, right], option_pictures: [{file: plates.svg, text: A left hand}, "
             "{file: plates.svg, text: A right hand}], ends_session: [lefty]",
             "forms.about.items[1].options[0]"},
      Change{", tie: {en: neither, ja: 同じ}", "", "blocks[12].tie"},
      Change{"max: 99", "max: 98", "forms.about.items[0].max"},
      Change{"    repetitions: 2\n", "    repetitions: 3\n", "blocks[0].repetitions"},
      Change{"stimuli: [b, a]", "stimuli: [a, b]", "blocks[0].stimuli[0]"},
      Change{"statement: A is more real.", "statement: B is more real.", "hypotheses[0].statement"},
      Change{"mass_kg: 0.058", "mass_kg: 0.0580001", "finger.mass_kg"},
      Change{"{from: 0.8e10, to: 1.2e10, spacing: log}", "[0.8e10, 1.3e10, log]",
             "stimuli.c.vary.youngs_modulus_pa.to"});
  const auto found = changes(every_key_text(), testing::replaced(every_key_text(), what, by));
  REQUIRE_FALSE(found.data_keys.empty());
  CHECK(found.data_keys.front() == key);
}

TEST_CASE("a protocol that is read as the same says the same, however it is written",
          "[protocols][texts]") {
  const auto [what, by] =
      GENERATE(std::pair{"mass_kg: 0.058", "mass_kg: 5.80e-2"},
               std::pair{"mass_kg: 0.058", "mass_kg: \"0.058\""},
               std::pair{"participants: 12\n", "participants: 012\n"},
               std::pair{"steps: 4, low: guessed", "steps: 0x4, low: guessed"},
               std::pair{"    practice: true\n", "    practice: yes\n"},
               std::pair{"load: {shipped: nasa_tlx}", "load: {'shipped': \"nasa_tlx\"}"},
               std::pair{"constraints: {max_run: 1, min_distance: 1}",
                         "constraints:\n      min_distance: 1\n      max_run: 1"},
               std::pair{"{from: 0.8e10, to: 1.2e10, spacing: log}", "[8e9, 1.20e10, log]"},
               std::pair{"middle: [0, 0]}\nrecordings", "middle: [0.0, 0]}\nrecordings"});
  const auto found = changes(every_key_text(), testing::replaced(every_key_text(), what, by));
  CHECK(found.data_keys == testing::Names{});
  CHECK(found.texts.empty());
}

// "01" and "1" are two names, and what is drawn depends on the order of those of stimuli.
TEST_CASE("names are as they are written, and in their order", "[protocols][texts]") {
  const auto with = [](const std::string& group) {
    return testing::replaced(testing::replaced(every_key_text(), "name: trained", "name: " + group),
                             "groups: [trained,", "groups: [" + group + ",");
  };
  CHECK(changes(with("01"), with("1")).data_keys ==
        testing::Names{"groups[0].name", "hypotheses[5].groups[0]"});
  CHECK(changes(with("01"), with("'01'")).data_keys == testing::Names{});
  const std::string oak =
      "  oak:\n    youngs_modulus_pa: 1.0e10\n    density_kg_per_m3: 700\n"
      "    poissons_ratio: 0.3\n    damping: {ratio: 0.02}\n";
  CHECK_THAT(
      changes(every_key_text(), testing::replaced(testing::replaced(every_key_text(), oak, ""),
                                                  "  mdf:\n", oak + "  mdf:\n"))
          .data_keys.at(0),
      Contains("its place"));
}

TEST_CASE("of a text that changed the first line that differs is told, with where it stands",
          "[protocols][texts]") {
  const auto with = [](const std::string& instructions) {
    return testing::text_with_blocks({"test"}, "instructions: |\n  Tap.\n  " + instructions + "\n");
  };
  const std::string before = with("Then answer.");
  const std::string now = with("Then choose.");
  const auto found =
      changes(testing::replaced(before, "\ninstructions:", "\n# a comment\n\ninstructions:"),
              testing::replaced(now, "question: \"Which?\"", "question: 'Which?'"));
  CHECK(found.data_keys == testing::Names{});
  REQUIRE(found.texts.size() == 1);
  CHECK(found.texts[0].before == "Then answer.");
  CHECK(found.texts[0].now == "Then choose.");
  const std::string up_to = now.substr(0, now.find("instructions: |"));
  CHECK(found.texts[0].line_now == 1 + std::count(up_to.begin(), up_to.end(), '\n'));
}

// A name may hold points, so that what it is of has the path of another's text.
TEST_CASE("a stimulus whose name ends in a key of texts is data", "[protocols][texts]") {
  const auto with = [](const std::string& material) {
    return testing::replaced(
        every_key_text(), "  d:\n",
        "  a.label: {plate: screwed, material: " + material +
            ", technique: fem, factors: {material: mdf, held: left, seen: left}}\n  d:\n");
  };
  CHECK(changes(with("mdf"), with("oak")).data_keys == testing::Names{"stimuli.a.label.material"});
}
