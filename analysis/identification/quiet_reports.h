#pragma once

#include "analysis/identification/measured.h"

namespace contour::identify {

/// Takes the noise off what a drive's own loop adds, as its reports have it. A report is the torque of one
/// instant, in which the loop's velocity gain has the encoder's noise; the mean over a period, which moves
/// the axis, has next to none of that. A fit that believes the reports finds that the axis hardly follows
/// force. Kept is, of each short stretch of time, what stands out at its frequencies from the noise of the
/// whole record: motion, and what answers a chirp. `delay_s` is that of the offset.
void QuietReports(double delay_s, Measured& data);

}  // namespace contour::identify
