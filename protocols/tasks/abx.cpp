#include "protocols/tasks/sample_task.hpp"
#include "protocols/tasks/task.hpp"
namespace tapstudy::protocols {
namespace {
// A and B differ; X is one of them again: which? (Munson & Gardner 1950)
class Abx final : public SampleTask {
 public:
  std::string_view name() const override { return "abx"; }
  std::string_view decision_model(const Block& /*block*/) const override {
    return "abx_differencing";
  }

 protected:
  std::size_t alternatives(const Block& /*block*/) const override { return 2; }
  std::vector<Layout> layouts(const Block& /*block*/) const override {
    return {{false, true, false}, {false, true, true}, {true, false, false}, {true, false, true}};
  }
};
}  // namespace

const Task& abx() {
  static const Abx task;
  return task;
}
}  // namespace tapstudy::protocols
