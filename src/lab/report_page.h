#pragma once
// The report's page, embedded from src/lab/report/: a Mustache template, its style and its script.

namespace gnomon {

extern const char* const kReportPageHtml;
extern const char* const kReportPageCss;
extern const char* const kReportPageJs;

}  // namespace gnomon
