#pragma once

#include <cstddef>
#include <functional>

namespace contour {

/// Does body(i) for every i below `count`, on at most so many threads, the caller's among them; returns when
/// all are done. The threads are those of one pool, which grows to what is asked for and stays. A body may
/// call this again: the caller always works itself, so nothing waits for a thread that is not free. What a
/// body throws first is thrown here, and what has not begun by then is left out.
void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// What an option `--threads` makes of its number: 0 is one per processor.
int ThreadsOf(int asked);

}  // namespace contour
