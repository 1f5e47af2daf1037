#pragma once
#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <new>
#include <string>
namespace tapstudy::testing {
// What a stand-in for a vendor's library shares with the test that runs its program: a file that
// both map, named by the environment variable Shared::variable.
template <class Shared>
class MappedStandIn {
 public:
  MappedStandIn()
      : file_{std::filesystem::temp_directory_path() /
              (std::string{"tapstudy_stand_in_"} + std::to_string(getpid()))} {
    const int descriptor = open(file_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (descriptor < 0 || ftruncate(descriptor, sizeof(Shared)) != 0) {
      throw std::bad_alloc{};
    }
    void* const mapped =
        mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    close(descriptor);
    shared_ = new (mapped) Shared;
    setenv(Shared::variable, file_.c_str(), 1);
  }
  ~MappedStandIn() {
    munmap(shared_, sizeof(Shared));
    std::filesystem::remove(file_);
  }
  MappedStandIn(const MappedStandIn&) = delete;
  MappedStandIn& operator=(const MappedStandIn&) = delete;
  MappedStandIn(MappedStandIn&&) = delete;
  MappedStandIn& operator=(MappedStandIn&&) = delete;
  Shared& device() { return *shared_; }

 private:
  std::filesystem::path file_;
  Shared* shared_{nullptr};
};

// In the program.
template <class Shared>
Shared& mapped_by_test() {
  const int file = open(std::getenv(Shared::variable), O_RDWR | O_CLOEXEC);
  void* const mapped = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  return *static_cast<Shared*>(mapped);
}
}  // namespace tapstudy::testing
