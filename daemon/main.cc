// contourd, the contouring servo daemon.
#include <exception>
#include <iostream>

#include "config/config_error.h"
#include "core/exit_status.h"
#include "daemon/daemon.h"
#include "daemon/options.h"
#include "drivers/can/socketcan_bus.h"

int main(int argc, char** argv) {
  contour::DaemonOptions options;
  switch (contour::ParseOptions(argc, argv, options)) {
    case contour::ParseResult::kDone:
      return contour::kExitDone;
    case contour::ParseResult::kBadUsage:
      return contour::kExitBadUsage;
    case contour::ParseResult::kRun:
      break;
  }
  try {
    return contour::RunDaemon(options);
  } catch (const contour::ConfigError& e) {
    std::cerr << e.what() << "\n";
    return contour::kExitBadUsage;
  } catch (const contour::EnvironmentError& e) {
    std::cerr << "contourd: " << e.what() << "\n";
    return contour::kExitEnvironment;
  } catch (const contour::BusUnavailable& e) {
    std::cerr << "contourd: " << e.what() << "\n";
    return contour::kExitEnvironment;
  } catch (const std::exception& e) {
    std::cerr << "contourd: " << e.what() << "\n";
    return contour::kExitFailed;
  }
}
