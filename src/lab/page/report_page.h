#pragma once
// Pages, embedded from this folder: Mustache templates of a comparison and of a medium, their style and script.

namespace gnomon {

extern const char* const kPageHtml;
extern const char* const kMediaHtml;
extern const char* const kPageCss;
extern const char* const kPageJs;

}  // namespace gnomon
