// Questionnaires.
#include <fmt/format.h>

#include <algorithm>

#include "protocols/form.hpp"
#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

FormItem read_item(MapReader& reader) {
  constexpr double any = 1e12;
  FormItem item;
  item.name = reader.name({"name", "unique in its form"});
  item.kind = reader.one_of<ItemKind>({"kind",
                                       "steps from 1; a mark on a line, stored as 0 to 1; a "
                                       "number; one of several options; free text"},
                                      item_kind_names);
  item.question = reader.translated({"question", "text that participants are asked"});
  item.is_required = reader.yes_or_no({"required", "must be answered"}, true);
  if (item.kind == ItemKind::likert) {
    item.steps = reader.integer({"steps", "likert: from 1 to this"}, 2, 11, item.steps);
  }
  if (item.kind == ItemKind::likert || item.kind == ItemKind::scale) {
    item.low =
        reader.translated({"low", "likert, scale: what the lowest means; unset: not of this kind"});
    item.high = reader.translated(
        {"high", "likert, scale: what the highest means; unset: not of this kind"});
  }
  if (item.kind == ItemKind::number) {
    item.min =
        reader.number({"min", "number: the lowest allowed; unset: not of this kind"}, {-any, any});
    item.max =
        reader.number({"max", "number: the highest allowed; unset: not of this kind"}, {-any, any});
    if (item.max <= item.min) {
      reader.reject("max", "is not above min");
    }
  }
  if (item.kind == ItemKind::single_choice) {
    for (const auto& [option, label] : reader.translated_list(
             {"options", "single_choice: to choose from; unset: not of this kind"})) {
      item.options.push_back({option, label});
    }
    reader.check("options", item.options.size() >= 2, R"({"minItems": 2})",
                 "a choice has at least two options");
  }
  return item;
}

Form read_form(const std::string& name, MapReader& reader) {
  Form form;
  if (reader.has("shipped")) {
    reader.word(
        {"shipped",
         "instead of the rest; nasa_tlx: the raw task load index, in English, German "
         "and Japanese (translations are ours, not validated); unset: the form is given here"},
        "form", {"nasa_tlx"});
    form = nasa_tlx(reader.language_among("shipped", nasa_tlx_languages()));
  } else {
    form.title = reader.translated({"title", "above the questions; unset: of a shipped form"});
    form.text = reader.translated_paragraphs({"text", "before the questions; paragraphs"}, "");
    reader.list(
        {"items", "the questions; unset: of a shipped form"}, Presence::at_least_one,
        [&](MapReader& inner) {
          const FormItem item = read_item(inner);
          if (std::ranges::find(form.items, item.name, &FormItem::name) != form.items.end()) {
            inner.reject("name", fmt::format("'{}' is the name of an earlier item", item.name));
          }
          form.items.push_back(item);
        });
  }
  form.name = name;
  return form;
}
}  // namespace

void read_forms(MapReader& top, Protocol& protocol) {
  top.each({"forms", "questionnaires, by name"}, Presence::optional,
           [&](const std::string& name, MapReader& reader) {
             protocol.forms.emplace(name, read_form(name, reader));
           });
  protocol.forms_before = read_form_names(
      top, {"forms_before", "names of forms, asked before the first trial"}, protocol);
  protocol.forms_after =
      read_form_names(top, {"forms_after", "names of forms, asked after the last trial"}, protocol);
}

std::vector<std::string> read_form_names(MapReader& reader, const Key& key,
                                         const Protocol& protocol) {
  return reader.words(key, "form", keys_of(protocol.forms), std::vector<std::string>{});
}

void read_display(MapReader& top, Protocol& protocol) {
  top.map(
      {"display", "what the pages of `run --console` show"}, Presence::optional,
      [&](MapReader& reader) {
        protocol.display.shows_plate =
            reader.yes_or_no({"plate",
                              "its shape, in neutral colour, with the pointer; not in blocks whose "
                              "plates look different"},
                             protocol.display.shows_plate);
        protocol.display.shows_tapping_points =
            reader.yes_or_no({"tapping_points", "as rings"}, protocol.display.shows_tapping_points);
        protocol.display.shows_fixations =
            reader.yes_or_no({"fixations", "where the plate is held: this shows which plate it is"},
                             protocol.display.shows_fixations);
        protocol.display.is_operator_blind = reader.yes_or_no(
            {"blind_operator", "the operator's page does not show what is presented and answered"},
            protocol.display.is_operator_blind);
      });
}

// Noise for the participant's ears.
namespace {
using core::NoiseKind;

void read_band(MapReader& reader, core::MaskingNoise& masking) {
  const bool is_band = masking.kind == NoiseKind::band;
  if (!is_band) {
    reader.refuse("band_hz", "is for kind: band only");
    return;
  }
  const Eigen::VectorXd edges_hz = reader.numbers({"band_hz",
                                                   "edges of the band, low and high, where it has "
                                                   "lost 3 dB; beyond it falls by 24 dB an octave"},
                                                  2, {20.0, 20'000.0});
  masking.low_hz = edges_hz[0];
  masking.high_hz = edges_hz[1];
  if (reader.has("band_hz") && masking.low_hz >= masking.high_hz) {
    reader.reject("band_hz", "its edges are not in order (low, then high)");
  }
}
}  // namespace

void read_masking(MapReader& top, Protocol& protocol) {
  top.map(
      {"masking",
       "noise that is played to the participant in every trial, so that the device is not heard; "
       "not in simulations; unset: none"},
      MapReader::Presence::optional, [&](MapReader& reader) {
        core::MaskingNoise& masking = protocol.masking.emplace();
        masking.kind = reader.one_of<NoiseKind>(
            {"kind",
             "the same power in every hertz, in every octave above 10 Hz, or in every hertz "
             "between two edges"},
            {{"white", NoiseKind::white}, {"pink", NoiseKind::pink}, {"band", NoiseKind::band}});
        masking.level_db_fs =
            reader.number({"level_db_fs", "RMS of the samples; 0 is an RMS of full scale"},
                          {-90.0, core::max_noise_level_db_fs});
        read_band(reader, masking);
        masking.ramp_s = reader.number(
            {"ramp_s", "from silence to the full level before a trial, and back after it"},
            {0.01, 5.0}, masking.ramp_s);
        masking.is_required = reader.yes_or_no(
            {"is_required", "without a card that plays there is no session, instead of a warning"},
            masking.is_required);
      });
}
}  // namespace tapstudy::protocols
