#pragma once
#include <string>
namespace tapstudy::runner {
// Held by one process of this machine at a time, and by none once it has ended, however it ended.
class OnlyOne {
 public:
  // Throws InvalidInput with `refusal` if another process holds the same.
  OnlyOne(const std::string& what, const std::string& refusal);
  ~OnlyOne();
  OnlyOne(const OnlyOne& other) = delete;
  OnlyOne& operator=(const OnlyOne& other) = delete;
  OnlyOne(OnlyOne&& other) = delete;
  OnlyOne& operator=(OnlyOne&& other) = delete;

 private:
  int socket_;
};
}  // namespace tapstudy::runner
