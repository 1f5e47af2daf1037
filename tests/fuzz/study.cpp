#include <filesystem>
#include <fstream>

#include "fuzz/input.hpp"
#include "results/store/store.hpp"
#include "results/store/study_queries.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    const std::filesystem::path directory =
        std::filesystem::temp_directory_path() / "tapstudy_fuzz_study";
    std::filesystem::create_directories(directory);
    std::ofstream{directory / "study.db", std::ios::binary} << text;
    auto store = tapstudy::results::Store::open_existing(directory.string());
    store.study();
    store.sessions();
    tapstudy::results::stored_answers(store);
    tapstudy::results::stored_visits(store);
    for (const std::int64_t trial : store.trials()) {
      store.trace(trial);
    }
  });
}
