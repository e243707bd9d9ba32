#pragma once
// What to answer to a name that is none of a list: the list, and the name that was probably meant.

#include <string>
#include <vector>

namespace gnomon {

// The one that differs by the fewest letters (missing, extra, wrong, or two swapped), or that begins with the word.
// Empty where more than a third of its letters differ: that is no slip of the finger.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

// "choose from a, b", or "did you mean a? Choose from a, b". `names`: "a, b".
std::string chooseFrom(const std::string& word, const std::string& names);

}  // namespace gnomon
