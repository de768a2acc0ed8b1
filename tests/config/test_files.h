#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace contour {

inline std::string ExampleMachine(const std::string& name) {
  return std::string(SOURCE_DIR) + "/config/" + name;
}

inline std::string ReadText(const std::string& path) {
  std::ifstream in(path);
  EXPECT_TRUE(in) << path;
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A file that belongs to the running test alone; its name is `name`.
inline std::string WriteTestFile(const std::string& name, const std::string& text) {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string path = ::testing::TempDir() + info->test_suite_name() + "_" + info->name() + "_" + name;
  for (std::size_t i = ::testing::TempDir().size(); i < path.size(); ++i)
    if (path[i] == '/') path[i] = '_';
  std::ofstream(path) << text;
  return path;
}

/// `text` with its first `from` replaced; a test that changes nothing fails.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "not in the example: " << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

}  // namespace contour
