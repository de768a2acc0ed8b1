#pragma once

#include <cstdint>
#include <string_view>

namespace contour {

/// Goes up when an older program could misread a log, or would compute something else from it.
/// 5: the drives are brought up in another way (StartUp::kOfLogFormat6); the messages are those of 4.
/// 6: path points may follow another law of time than the program's own, and say so.
/// 7: a SYNC is left out where a drive's first answer came late.
inline constexpr std::int32_t kLogFormatVersion = 7;
inline constexpr std::int32_t kOldestReadFormat = 4;
inline constexpr std::int32_t kStartUpOf6SinceFormat = 5;
inline constexpr std::int32_t kStartUpNowSinceFormat = 7;

inline constexpr std::string_view kHeaderChannel = "CONTOUR_LOG_HEADER";
inline constexpr std::string_view kStateChannel = "CONTOUR_LOG_STATE";
inline constexpr std::string_view kNoteChannel = "CONTOUR_LOG_NOTE";
inline constexpr std::string_view kFooterChannel = "CONTOUR_LOG_FOOTER";

/// Begins every event of an LCM log.
inline constexpr std::uint32_t kLcmEventSync = 0xEDA1DA01u;

}  // namespace contour
