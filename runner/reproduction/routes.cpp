#include "runner/reproduction/routes.hpp"

#include "runner/reproduction/claim.hpp"
namespace tapstudy::runner {
const std::vector<Route>& routes() {
  static const std::vector<Route> all{
      {std::string{method::printed}, "protocols/paper/forces.yaml", "aluminium"},
      {std::string{method::recommended}, "protocols/recommended/forces.yaml", "aluminium"},
      {"5 mm thick", "protocols/recommended/forces_thin.yaml", "aluminium"},
      {"5 mm thick, aluminium of 70 GPa", "protocols/recommended/forces_thin.yaml", "metal"},
  };
  return all;
}

}  // namespace tapstudy::runner
