#pragma once

namespace contour::diagnosis {

/// For programs that diagnose: memory that was used once stays with the process. Arrays of a megabyte come
/// and go by the thousand; handed back each time, the system's work on fresh pages takes a tenth of the time.
void KeepMemory();

}  // namespace contour::diagnosis
