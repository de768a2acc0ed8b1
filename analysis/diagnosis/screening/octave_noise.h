#pragma once

#include <vector>

namespace contour::diagnosis {

/// Scores of a spectrum in rising order, each a chi^2 of two degrees where nothing but the noise of the
/// model is there. Where half of an octave has more than that, that is the noise there, and the score is over
/// it: rows on the edge of a slide are at all orders, and noise has another colour than the whitener took.
void OverTheOctave(std::vector<double>& scores);

}  // namespace contour::diagnosis
