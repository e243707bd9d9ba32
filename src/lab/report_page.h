#pragma once
// Pages, embedded from src/lab/report/: Mustache templates (of a comparison, of a medium, of a paper), their
// styles and script. A paper's page (reproduce.html) has the report's style, and its own beside it.

namespace gnomon {

extern const char* const kReportPageHtml;
extern const char* const kReportMediaHtml;
extern const char* const kReportPageCss;
extern const char* const kReportPageJs;
extern const char* const kReportReproduceHtml;
extern const char* const kReportReproduceCss;

}  // namespace gnomon
