#pragma once
// The page of a sweep, embedded from this folder: its frame, style and script.

namespace gnomon {

extern const char* const kSweepHtml;
extern const char* const kSweepCss;
extern const char* const kSweepJs;

}  // namespace gnomon
