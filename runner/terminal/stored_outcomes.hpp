#pragma once
#include <future>
#include <string>
#include <vector>
namespace tapstudy::runner {
// An operator's command that was carried out, and its record on the way to the disk.
struct PostedCommand {
  std::string said;  // what is done
  std::shared_future<void> stored;
};

// Says of each command whether it is stored, once that is known: nobody who types waits for a disk.
class StoredOutcomes {
 public:
  // Both written around each outcome.
  StoredOutcomes(std::string indent, std::string prompt)
      : indent_{std::move(indent)}, prompt_{std::move(prompt)} {}
  void add(PostedCommand command) { open_.push_back(std::move(command)); }
  void say_known();
  // Waits until every command was stored, or could not be.
  void finish();

 private:
  void say_outcome(const PostedCommand& command) const;
  std::string indent_;
  std::string prompt_;
  std::vector<PostedCommand> open_;
};
}  // namespace tapstudy::runner
