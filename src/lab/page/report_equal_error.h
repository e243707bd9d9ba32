#pragma once
// The page's section of --until-error: a table, and error against texels and against frame time, a line for each
// method.

#include "lab/page/report_views.h"
#include "lab/results/equal_error.h"

namespace gnomon {

TemplateData equalErrorView(const EqualError& equal);

}  // namespace gnomon
