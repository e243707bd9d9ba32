#pragma once
// A paper's page, embedded from this folder: its Mustache template, and its own style beside the report's.

namespace gnomon {

extern const char* const kReproduceHtml;
extern const char* const kReproduceCss;

}  // namespace gnomon
