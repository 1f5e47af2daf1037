// What is confirmed lies on the disk, whatever the disk did before.
#include <sys/syscall.h>
#include <unistd.h>

#include <filesystem>

#include "results/journal/journal.hpp"
#include "results/store/store.hpp"
#include "results/store_error.hpp"
#include "support/catch.hpp"
#include "support/stored_study.hpp"
#include "support/texts.hpp"

namespace {
// A journal's file on a disk that refuses to be flushed a number of times. As Linux does, it says
// so once: what failed then counts as written, and the next fsync has nothing to do until it is
// written again.
struct FailingDisk {
  std::string flushed{};  // what a power failure would leave
  std::string given_up{};
  bool is_written_again{false};
  int failures{0};
  int flushes{0};
};
FailingDisk* failing_disk = nullptr;  // of the test that runs

std::string name_of(int descriptor) {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), error)
      .string();
}
bool is_of_failing_disk(int descriptor) {
  return failing_disk != nullptr && name_of(descriptor).ends_with("answers.journal");
}
}  // namespace

// In the place of the C library's, for this program.
extern "C" int fsync(int descriptor) {
  if (!is_of_failing_disk(descriptor)) {
    return static_cast<int>(syscall(SYS_fsync, descriptor));
  }
  const std::string text = tapstudy::testing::contents(name_of(descriptor));
  ++failing_disk->flushes;
  if (failing_disk->failures > 0) {
    --failing_disk->failures;
    failing_disk->given_up = text;
    failing_disk->is_written_again = false;
    errno = EIO;
    return -1;
  }
  if (failing_disk->is_written_again || text != failing_disk->given_up) {
    failing_disk->flushed = text;
  }
  return 0;
}
extern "C" ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  if (is_of_failing_disk(descriptor)) {
    failing_disk->is_written_again = true;
  }
  return syscall(SYS_pwrite64, descriptor, bytes, count, offset);
}

namespace {
using namespace tapstudy;
using namespace tapstudy::results;

StudyRow flushed_study() {
  return {"a study", "study.yaml", "format: tapstudy/1\n", "hash", {}};
}
JournalEntries a_note(const std::string& text) {
  return {.actions = {{1, 0.5, "note", std::nullopt, text}}};
}

class OnFailingDisk {
 public:
  OnFailingDisk() { failing_disk = &disk; }
  ~OnFailingDisk() { failing_disk = nullptr; }
  OnFailingDisk(const OnFailingDisk&) = delete;
  OnFailingDisk& operator=(const OnFailingDisk&) = delete;
  OnFailingDisk(OnFailingDisk&&) = delete;
  OnFailingDisk& operator=(OnFailingDisk&&) = delete;
  FailingDisk disk{};
  testing::TempDirectory directory{};
};
}  // namespace

TEST_CASE("a line that the disk took, but did not flush, is confirmed only once it is flushed",
          "[results][journal]") {
  OnFailingDisk on;
  Journal journal{on.directory.path()};
  journal.complete(flushed_study, {}, a_note("the first"));
  on.disk.failures = 2;
  CHECK_THROWS_AS(journal.complete(flushed_study, {}, a_note("the end")), StoreError);
  CHECK_THROWS_AS(journal.complete(flushed_study, {}, a_note("the end")), StoreError);
  CHECK_THAT(on.disk.flushed, !Contains("the end"));
  journal.complete(flushed_study, {}, a_note("the end"));  // says that it is there
  CHECK_THAT(on.disk.flushed, Contains("the first") && Contains("the end"));
  CHECK(on.disk.flushed == testing::contents(journal_file(on.directory.path())));
  CHECK(read_journal(on.directory.path()).entries.actions.size() == 2);
}

TEST_CASE("a line of a program that died before it flushed it is flushed by who finds it",
          "[results][journal]") {
  OnFailingDisk on;
  {
    Journal killed{on.directory.path()};
    killed.set_flush(Journal::Flush::when_asked);
    killed.complete(flushed_study, {}, a_note("the end"));
  }
  REQUIRE(on.disk.flushed.empty());
  Journal{on.directory.path()}.complete(flushed_study, {}, a_note("the end"));
  CHECK_THAT(on.disk.flushed, Contains("the end"));
}

TEST_CASE("what is flushed is not flushed again", "[results][journal]") {
  OnFailingDisk on;
  Journal journal{on.directory.path()};
  journal.complete(flushed_study, {}, a_note("the end"));
  journal.complete(flushed_study, {}, a_note("the end"));
  CHECK(on.disk.flushes == 1);
}

TEST_CASE("a note whose line failed is journalled with the next answer, or when the store closes",
          "[results][journal][store]") {
  namespace small = testing::small_study;
  OnFailingDisk on;
  const bool answers = GENERATE(true, false);
  {
    auto [store, row] = small::begun_study(on.directory.path());
    on.disk.failures = 1;
    CHECK_THROWS_AS(store.add_operator_action({row.id, 0.5, "note", std::nullopt, "odd"}),
                    StoreError);
    if (answers) {
      store.add_trial(small::trial(row.id, 1, "a"));
      CHECK_THAT(on.disk.flushed, Contains("odd"));
    }
  }
  CHECK_THAT(on.disk.flushed, Contains("odd"));
}
