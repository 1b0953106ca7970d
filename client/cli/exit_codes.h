#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// What the program's exit code says, for every command.
enum ExitCode : int {
  kExitFound = 0,     ///< found, or the work is done
  kExitNotFound = 1,  ///< the input was sound, the object is not there
  kExitBadInput = 2,  ///< bad options or files; one line on stderr says which
};

/// Ends the running command with kExitNotFound, without a message: the command has printed its own.
[[noreturn]] inline void exit_not_found() { throw CLI::RuntimeError(kExitNotFound); }

}  // namespace edgepose
