#pragma once
// The report's page, embedded from src/lab/report/: Mustache templates (of a
// comparison and of a medium), their style and their script.

namespace gnomon {

extern const char* const kReportPageHtml;
extern const char* const kReportMediaHtml;
extern const char* const kReportPageCss;
extern const char* const kReportPageJs;

}  // namespace gnomon
