#pragma once
// Comments of GLSL as the compiler has them: `//` goes on behind a backslash at a line's end, lines end in \n, \r\n or
// \r, and a `/*` without end reaches to the end of the text.

#include <string>

namespace gnomon::gpu {

// Line breaks within comments stay, so that lines are counted as before; or are blanks, too, as a directive takes them,
// which goes on behind a comment of several lines.
enum class CommentBreaks { Kept, Blanked };

// The text with blanks for comments: what is left keeps its place.
std::string blankComments(std::string glsl, CommentBreaks breaks = CommentBreaks::Kept);

}  // namespace gnomon::gpu
