#include "daemon/logging/logging.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/exit_status.h"
#include "daemon/logging/background_sink.h"

namespace contour {
namespace {

/// The priority of sd-daemon(3), which the journal takes off the line again.
class JournalPriority final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string_view priority = Priority(message.level);
    out.append(priority.data(), priority.data() + priority.size());
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return spdlog::details::make_unique<JournalPriority>();
  }

 private:
  static std::string_view Priority(spdlog::level::level_enum level) {
    switch (level) {
      case spdlog::level::critical:
        return "<2>";
      case spdlog::level::err:
        return "<3>";
      case spdlog::level::warn:
        return "<4>";
      case spdlog::level::info:
        return "<6>";
      default:
        return "<7>";
    }
  }
};

/// Some thousand lines.
constexpr std::size_t kWaiting_bytes = 1u << 20;

constexpr const char* kPattern = "%Y-%m-%d %H:%M:%S.%e %^%-7l%$ %v";

spdlog::sink_ptr JournalSink() {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<JournalPriority>('*').set_pattern("%*%v");
  sink->set_formatter(std::move(formatter));
  return sink;
}

spdlog::sink_ptr StderrSink() {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  sink->set_pattern(kPattern);
  return sink;
}

spdlog::sink_ptr FileSink(const LoggingOptions& options) {
  try {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(
        options.file->string(), options.max_file_bytes, options.max_files);
    sink->set_pattern(kPattern);
    return sink;
  } catch (const spdlog::spdlog_ex& e) {
    throw EnvironmentError("cannot write the log file " + options.file->string() + ": " + e.what());
  }
}

std::shared_ptr<BackgroundSink>& DefaultSink() {
  static std::shared_ptr<BackgroundSink> sink;
  return sink;
}

}  // namespace

std::shared_ptr<spdlog::logger> MakeLogger(const LoggingOptions& options, bool to_journal) {
  std::vector<spdlog::sink_ptr> sinks{to_journal ? JournalSink() : StderrSink()};
  if (options.file) sinks.push_back(FileSink(options));
  auto logger = std::make_shared<spdlog::logger>("contourd", sinks.begin(), sinks.end());
  logger->set_level(options.level);
  // What goes wrong is to be on disk before what comes next can take the program with it.
  logger->flush_on(spdlog::level::warn);
  return logger;
}

void SetUpLogging(const LoggingOptions& options) {
  DefaultSink() = std::make_shared<BackgroundSink>(MakeLogger(options, StderrIsJournal()), kWaiting_bytes);
  auto logger = std::make_shared<spdlog::logger>("contourd", DefaultSink());
  logger->set_level(options.level);
  logger->flush_on(spdlog::level::warn);
  spdlog::set_default_logger(std::move(logger));
}

bool FinishLogging(std::chrono::steady_clock::time_point deadline) {
  return DefaultSink() == nullptr || DefaultSink()->Finish(deadline);
}

bool StderrIsJournal() {
  // systemd sets DEVICE:INODE of the stream it made; a stderr that was redirected since is another one.
  const char* stream = std::getenv("JOURNAL_STREAM");  // NOLINT(concurrency-mt-unsafe): at start-up
  struct stat own {};
  if (stream == nullptr || ::fstat(STDERR_FILENO, &own) != 0) return false;
  return std::to_string(own.st_dev) + ':' + std::to_string(own.st_ino) == stream;
}

}  // namespace contour
