#include <algorithm>

#include "protocols/tasks/shipped_tasks.hpp"
namespace tapstudy::protocols {
const std::vector<const Task*>& tasks() {
  static const std::vector<const Task*> table{&identification(), &choice(),          &comparison(),
                                              &same_different(), &odd_one_out(),     &abx(),
                                              &paired(),         &ranking(),         &rating(),
                                              &magnitude(),      &match_to_sample(), &adjustment()};
  return table;
}

const Task* find_task(std::string_view name) {
  const auto found = std::ranges::find(tasks(), name, &Task::name);
  return found == tasks().end() ? nullptr : *found;
}

std::string blind_label(std::size_t position) {
  return {static_cast<char>('A' + static_cast<char>(position))};
}
}  // namespace tapstudy::protocols
