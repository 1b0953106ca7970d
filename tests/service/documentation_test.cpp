/// docs/service.md explains every event of the log and every counter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

namespace edgepose::test {
namespace {

const std::filesystem::path kSource(EDGEPOSE_SOURCE_DIR);

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// What the group of `pattern` matches in the daemon's sources.
std::set<std::string> named(const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> names;
  for (const char* folder : {"server", "daemon"})
    for (const auto& entry : std::filesystem::directory_iterator(kSource / folder)) {
      const std::string text = text_of(entry.path());
      for (auto it = std::sregex_iterator(text.begin(), text.end(), regex); it != std::sregex_iterator();
           ++it)
        names.insert((*it)[1].str());
    }
  return names;
}

TEST(ServiceDocumentation, ExplainsEveryEvent) {
  const std::string document = text_of(kSource / "docs/service.md");
  const auto events = named(R"rx(log_(?:event|limited)\(\s*LogLevel::\w+,\s*"([a-z_]+)")rx");
  EXPECT_GE(events.size(), 15u);
  for (const std::string& event : events)
    EXPECT_NE(document.find("\n| `" + event + "` | "), std::string::npos) << event;
}

TEST(ServiceDocumentation, ExplainsEveryCounter) {
  const std::string document = text_of(kSource / "docs/service.md");
  auto counters = named(R"rx([\s.]add\(\s*"([a-z_]+)")rx");
  counters.merge(named(R"rx("(answers_[a-z_]+)")rx"));
  EXPECT_GE(counters.size(), 25u);
  for (std::string counter : counters) {
    for (const std::string refused : {"commands_refused_", "frames_refused_"})
      if (counter.starts_with(refused)) counter = refused;
    if (counter.ends_with('_')) counter += "CAUSE";
    EXPECT_NE(document.find("\n| `" + counter + "` | "), std::string::npos) << counter;
  }
}

TEST(ServiceDocumentation, NamesEveryCauseOfRefusal) {
  const std::string document = text_of(kSource / "docs/service.md");
  const auto causes = named(R"rx(return \{"([a-z_]+)")rx");
  EXPECT_THAT(causes, testing::Contains("too_old"));
  for (const std::string& cause : causes)
    EXPECT_NE(document.find("`" + cause + "`"), std::string::npos) << cause;
}

}  // namespace
}  // namespace edgepose::test
