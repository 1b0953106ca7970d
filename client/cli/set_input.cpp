#include "client/cli/set_input.h"

#include "client/cli/model_input.h"
#include "evaluation/selection.h"
#include "settings/matcher_settings.h"

namespace edgepose {

void SetInput::add_options(CLI::App& command) {
  command.add_option("SET", folder, "Test set: a folder in the BOP format, or in UWA's own layout")
      ->required();
  command.add_option("--objects", objects, "Only these objects (names or numbers)")->delimiter(',');
  command.add_option("--images", images, "Only these image numbers: 3, 3-7, 3- or -7");
  command.add_option("--threads", threads, "Threads; 0 = all cores; never changes the result")
      ->check(CLI::Range(0, kMaxThreads));
  command.add_option("--config", config, "TOML file with any option (config/edgepose.toml)");
}

TestSet SetInput::read() const {
  Selection selection;
  selection.objects = objects;
  if (!images.empty()) parse_images(images, selection);
  return select(read_test_set(folder), selection);
}

EvalOptions SetInput::options() const {
  EvalOptions options;
  if (!config.empty()) {
    const Settings settings = read_settings(config);
    options.train = settings.train;
    options.scene = settings.scene;
    options.match = settings.match;
  }
  options.threads = threads;
  return options;
}

std::vector<std::filesystem::path> SetInput::files(const TestSet& set) const {
  std::vector<std::filesystem::path> list = set.descriptions;
  list.push_back(config);
  for (const TestObject& object : set.objects) list.push_back(object.mesh);
  for (const TestImage& image : set.images) list.push_back(image.cloud.empty() ? image.depth : image.cloud);
  return list;
}

std::string SetInput::command_line() const {
  std::string text = shell_quoted(folder.string());
  for (const std::string& object : objects) text += " --objects " + shell_quoted(object);
  if (!images.empty()) text += " --images " + shell_quoted(images);
  if (!config.empty()) text += " --config " + shell_quoted(config.string());
  if (threads) text += " --threads " + std::to_string(*threads);
  return text;
}

std::string shell_quoted(const std::string& argument) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
  std::string quoted = "'";
  for (char c : argument) {
    if (c == '\'')
      quoted += "'\\''";
    else
      quoted += c;
  }
  return quoted + "'";
}

}  // namespace edgepose
