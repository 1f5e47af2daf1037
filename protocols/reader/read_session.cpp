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
  item.name = reader.name("name");
  item.kind = reader.one_of<ItemKind>("kind", item_kind_names);
  item.question = reader.translated("question");
  item.is_required = reader.yes_or_no("required", true);
  if (item.kind == ItemKind::likert) {
    item.steps = reader.integer("steps", 2, 11, item.steps);
  }
  if (item.kind == ItemKind::likert || item.kind == ItemKind::scale) {
    item.low = reader.translated("low");
    item.high = reader.translated("high");
  }
  if (item.kind == ItemKind::number) {
    item.min = reader.number("min", {-any, any});
    item.max = reader.number("max", {-any, any});
    if (item.max <= item.min) {
      reader.reject("max", "is not above min");
    }
  }
  if (item.kind == ItemKind::single_choice) {
    for (const auto& [option, label] : reader.translated_list("options")) {
      item.options.push_back({option, label});
    }
    if (item.options.size() < 2) {
      reader.reject("options", "a choice has at least two options");
    }
  }
  return item;
}

Form read_form(const std::string& name, MapReader& reader) {
  Form form;
  if (reader.has("shipped")) {
    reader.word("shipped", "form", {"nasa_tlx"});
    form = nasa_tlx(reader.language_among("shipped", nasa_tlx_languages()));
  } else {
    form.title = reader.translated("title");
    form.text = reader.translated_paragraphs("text", "");
    reader.list("items", Presence::at_least_one, [&](MapReader& inner) {
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
  top.each("forms", Presence::optional, [&](const std::string& name, MapReader& reader) {
    protocol.forms.emplace(name, read_form(name, reader));
  });
  protocol.forms_before = read_form_names(top, "forms_before", protocol);
  protocol.forms_after = read_form_names(top, "forms_after", protocol);
}

std::vector<std::string> read_form_names(MapReader& reader, const std::string& key,
                                         const Protocol& protocol) {
  return reader.words(key, "form", keys_of(protocol.forms), std::vector<std::string>{});
}

void read_display(MapReader& top, Protocol& protocol) {
  top.map("display", Presence::optional, [&](MapReader& reader) {
    protocol.display.shows_plate = reader.yes_or_no("plate", protocol.display.shows_plate);
    protocol.display.shows_tapping_points =
        reader.yes_or_no("tapping_points", protocol.display.shows_tapping_points);
    protocol.display.shows_fixations =
        reader.yes_or_no("fixations", protocol.display.shows_fixations);
    protocol.display.is_operator_blind =
        reader.yes_or_no("blind_operator", protocol.display.is_operator_blind);
  });
}

// Noise for the participant's ears.
namespace {
using core::NoiseKind;

void read_band(MapReader& reader, core::MaskingNoise& masking) {
  const bool is_band = masking.kind == NoiseKind::band;
  if (!is_band && !reader.has("band_hz")) {
    return;
  }
  const Eigen::VectorXd edges_hz = reader.numbers("band_hz", 2, {20.0, 20'000.0});
  masking.low_hz = edges_hz[0];
  masking.high_hz = edges_hz[1];
  if (!is_band) {
    reader.reject("band_hz", "is for kind: band only");
  } else if (reader.has("band_hz") && masking.low_hz >= masking.high_hz) {
    reader.reject("band_hz", "its edges are not in order (low, then high)");
  }
}
}  // namespace

void read_masking(MapReader& top, Protocol& protocol) {
  top.map("masking", MapReader::Presence::optional, [&](MapReader& reader) {
    core::MaskingNoise& masking = protocol.masking.emplace();
    masking.kind = reader.one_of<NoiseKind>(
        "kind",
        {{"white", NoiseKind::white}, {"pink", NoiseKind::pink}, {"band", NoiseKind::band}});
    masking.level_db_fs = reader.number("level_db_fs", {-90.0, core::max_noise_level_db_fs});
    read_band(reader, masking);
    masking.ramp_s = reader.number("ramp_s", {0.01, 5.0}, masking.ramp_s);
    masking.is_required = reader.yes_or_no("is_required", masking.is_required);
  });
}
}  // namespace tapstudy::protocols
