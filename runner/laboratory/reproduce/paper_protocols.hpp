#pragma once
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// The files below protocols/paper and protocols/recommended, as they were when the program was
// built. Names are from the sources' root: "protocols/paper/forces.yaml".

// Throws InvalidInput if there is none of that name.
std::string shipped_text(const std::string& file);
protocols::Protocol shipped_protocol(const std::string& file);

// The plates of Figures 4 and 5, six by each route: materials `mdf`, `acrylic` and an aluminium,
// held at `two` or `four` points.
struct Route {
  std::string name;
  std::string file;       // of the protocol, shipped
  std::string aluminium;  // which of its materials that is
  bool is_printed{};
  bool differs_in_aluminium_only{};  // from the one before
  std::vector<std::string> materials() const { return {"mdf", "acrylic", aluminium}; }
};

// The routes are: as printed (protocols/paper, plates of 5 cm, linear elements, single vertices
// held, Newmark); as recommended (protocols/recommended, quadratic elements, screws' heads, the
// exact integrator); and 5 mm thick, as recommended with a tenth of the printed thickness, with the
// printed modulus of aluminium (1 GPa) and with the metal's (70 GPa).
const std::vector<Route>& routes();

// A protocol with its plates 5 mm thick, meshed as in protocols/recommended/forces_thin.yaml.
protocols::Protocol with_thin_plates(protocols::Protocol protocol);
inline constexpr const char* thin_plate_changes =
    "size_m: [0.6, 0.6, 0.005] and the mesh of protocols/recommended/forces_thin.yaml";

// The command that shows a plate's modes; that taps it at a named point, with what is asked beside.
std::string modes_command(const std::string& file, const std::string& stimulus);
std::string tap_command(const std::string& file, const std::string& stimulus,
                        const std::string& point, const std::string& options = "--csv tap.csv");

inline constexpr double tap_speed_m_s = 0.3;  // the paper gives none
}  // namespace tapstudy::runner
