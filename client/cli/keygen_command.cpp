#include "client/cli/keygen_command.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "client/cli/option_checks.h"
#include "messaging/authentication.h"

namespace edgepose {
namespace {

constexpr const char* kKeygenExamples = R"(Examples:
  edgepose keygen /etc/edgepose/key
  edgepose keygen ~/edgepose.key && edgepose watch --key ~/edgepose.key

The file is for its owner only (mode 0600); chgrp and chmod 640 let a group read it. A key is never replaced.)";

}  // namespace

void add_keygen_command(CLI::App& app) {
  auto path = std::make_shared<std::filesystem::path>();
  CLI::App* keygen = app.add_subcommand("keygen", "Make a secret key that the daemon and its clients share");
  add_output_option(*keygen, "FILE", *path, "Key file to write; must not exist")->required();
  keygen->footer(kKeygenExamples);
  keygen->callback([path] {
    SecretKey::random().write(*path);
    std::cout << "key: " << path->string() << '\n';
  });
}

}  // namespace edgepose
