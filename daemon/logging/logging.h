#pragma once

#include <spdlog/common.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

namespace spdlog {
class logger;
}

namespace contour {

struct LoggingOptions {
  spdlog::level::level_enum level = spdlog::level::info;
  std::optional<std::filesystem::path> file;  ///< beside stderr; its directory is made when missing
  std::size_t max_file_bytes = 10u << 20;
  std::size_t max_files = 5;  ///< older ones are NAME.1.log, NAME.2.log, ...
};

/// A logger to stderr and, if wanted, a rotating file. To the journal each line goes with its priority (<3>
/// and so on) and without the time, which the journal knows; elsewhere with the time, and in colour on a
/// terminal. Throws EnvironmentError when the file cannot be written.
std::shared_ptr<spdlog::logger> MakeLogger(const LoggingOptions& options, bool to_journal);

/// Makes that the default logger of spdlog. Everything may log except the cycle and what it calls. Lines are
/// written by a thread of their own: a stderr or a disk that takes nothing holds nobody up. Lines that find
/// no room are lost, and the next one that does says how many.
void SetUpLogging(const LoggingOptions& options);
/// Before the process ends: whether all lines were written by then. Later lines are lost.
bool FinishLogging(std::chrono::steady_clock::time_point deadline);

/// Whether stderr goes to the systemd journal.
bool StderrIsJournal();

}  // namespace contour
