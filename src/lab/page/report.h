#pragma once
// The HTML report of a folder with results: one self-contained file, which works offline. Without JavaScript it still
// shows the table, the plot, every picture and the text.

#include <filesystem>
#include <string>

namespace gnomon {

// HTML of folder/results.json and the pictures it names. Throws WorldError: no results.json, or one that does
// not follow docs/results.md. A picture that cannot be read is left out, and the page says so.
std::string reportHtml(const std::filesystem::path& folder);

}  // namespace gnomon
