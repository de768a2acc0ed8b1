#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace contour {

/// A flag and its contrary, `"--this,!--no-this"`, for a choice that somebody else makes where neither is
/// given. CLI11's own flag would take an optional for a count, and set it to 0 in advance.
inline CLI::Option* AddChoice(CLI::App& app, const std::string& names, std::optional<bool>& choice,
                              const std::string& text) {
  return app.add_flag_function(
      names, [&choice](std::int64_t count) { choice = count > 0; }, text);
}

}  // namespace contour
