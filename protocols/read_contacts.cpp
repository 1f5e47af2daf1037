// Bodies that a tapped plate touches, and the springs between them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <variant>

#include "protocols/allowed.hpp"
#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
using EndsByName = std::map<std::string, core::ContactSpring::End>;  // by "body.point"

// Refinement follows one body's frequencies, and they have them together.
void check_mesh(MapReader& reader, const std::string& key, const Plate& plate) {
  if (plate.mesh.accuracy) {
    reader.reject(key,
                  "its mesh has an accuracy, to which bodies in contact are not refined (give "
                  "max_tet_volume_m3)");
  }
}

void add_points(const std::string& body, const std::shared_ptr<const Plate>& plate,
                Contacts& contacts, EndsByName& ends) {
  if (plate) {
    for (const auto& [name, region] : plate->contact_points) {
      ends.emplace(fmt::format("{}.{}", body, name),
                   core::ContactSpring::End{contacts.plates.size(), region});
    }
  }
  contacts.plates.push_back(plate);
}

void read_body(const std::string& name, MapReader& reader, const Protocol& protocol,
               Contacts& contacts, EndsByName& ends) {
  const auto plate =
      named(protocol.plates, reader.word("plate", "plate", keys_of(protocol.plates)));
  const auto material =
      named(protocol.materials, reader.word("material", "material", keys_of(protocol.materials)));
  if (plate) {
    check_mesh(reader, "plate", *plate);
  }
  if (material && std::holds_alternative<core::ModalDamping>(material->damping)) {
    reader.reject("material", modal_ratios_in_contact);
  }
  core::BodyInContact body;
  if (plate) {
    static_cast<core::Plate&>(body) = *plate;
  }
  if (material) {
    body.material = *material;
  }
  contacts.bodies.push_back(std::move(body));
  add_points(name, plate, contacts, ends);
}

// nullopt for a name that was rejected.
std::optional<core::ContactSpring::End> read_end(MapReader& reader, const std::string& key,
                                                 const EndsByName& ends) {
  const auto found = ends.find(reader.word(key, "contact point", keys_of(ends)));
  return found == ends.end() ? std::nullopt : std::optional{found->second};
}

// nullopt where an end was rejected.
std::optional<core::ContactSpring> read_spring(MapReader& reader, const EndsByName& ends) {
  core::ContactSpring spring;
  const auto from = read_end(reader, "from", ends);
  const auto to = read_end(reader, "to", ends);
  if (from && to && from->body == to->body) {
    reader.reject("to", "is a point of the same body as from");
  }
  spring.stiffness_n_per_m = reader.numbers("springs_n_per_m", 3, allowed::spring_n_per_m);
  if (spring.stiffness_n_per_m.isZero(0.0)) {
    reader.reject("springs_n_per_m", "joins nothing: every stiffness is 0");
  }
  spring.loss_factor = reader.number("loss_factor", {0.0, 2.0}, 0.0);
  if (!from || !to) {
    return std::nullopt;
  }
  spring.from = *from;
  spring.to = *to;
  return spring;
}

// A body that no springs lead to would ring unfelt.
void check_are_joined(MapReader& reader, const Contacts& contacts,
                      const std::vector<std::string>& bodies) {
  std::vector<bool> is_joined(bodies.size() + 1, false);
  is_joined[0] = true;
  for (std::size_t round = 0; round < bodies.size(); ++round) {
    for (const core::ContactSpring& spring : contacts.springs) {
      const bool is_either = is_joined[spring.from.body] || is_joined[spring.to.body];
      is_joined[spring.from.body] = is_either;
      is_joined[spring.to.body] = is_either;
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_joined[i + 1]) {
      reader.reject("bodies", fmt::format("no springs lead from '{}' to the plate that is tapped",
                                          bodies[i]));
    }
  }
}

Contacts read_set(MapReader& reader, const Protocol& protocol) {
  Contacts contacts;
  EndsByName ends;
  const std::string tapped = reader.word("tapped", "plate", keys_of(protocol.plates));
  add_points(tapped, named(protocol.plates, tapped), contacts, ends);
  if (contacts.plates.front()) {
    check_mesh(reader, "tapped", *contacts.plates.front());
  }
  std::vector<std::string> bodies;
  bool are_ends_known = true;
  reader.each("bodies", Presence::required, [&](const std::string& name, MapReader& body) {
    bodies.push_back(name);
    if (name == tapped) {
      body.reject("has the name of the plate that is tapped");
    }
    read_body(name, body, protocol, contacts, ends);
  });
  reader.list("springs", Presence::at_least_one, [&](MapReader& inner) {
    const auto spring = read_spring(inner, ends);
    are_ends_known = are_ends_known && spring;
    contacts.springs.push_back(spring.value_or(core::ContactSpring{}));
  });
  if (are_ends_known && !contacts.springs.empty()) {
    check_are_joined(reader, contacts, bodies);
  }
  return contacts;
}
}  // namespace

void read_contacts(MapReader& top, Protocol& protocol) {
  top.each("contacts", Presence::optional, [&](const std::string& name, MapReader& reader) {
    protocol.contacts[name] = std::make_shared<const Contacts>(read_set(reader, protocol));
  });
}

void check_contacts(MapReader& reader, const Stimulus& stimulus, const Protocol& protocol) {
  if (!stimulus.contacts) {
    return;
  }
  const auto& tapped = stimulus.contacts->plates.front();
  if (stimulus.plate && tapped && stimulus.plate != tapped) {
    const auto name = std::ranges::find_if(
        protocol.plates, [&](const auto& known) { return known.second == tapped; });
    reader.reject("contacts", fmt::format("are those of plate '{}'", name->first));
  }
  if (stimulus.material && std::holds_alternative<core::ModalDamping>(stimulus.material->damping)) {
    reader.reject("material", modal_ratios_in_contact);
  }
  if (stimulus.technique != nullptr && stimulus.technique->needs_beam()) {
    reader.reject("contacts", fmt::format("technique '{}' computes a plate that touches no other",
                                          stimulus.technique->name));
  }
}
}  // namespace tapstudy::protocols
