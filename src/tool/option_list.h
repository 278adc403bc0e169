// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

#include <boost/program_options.hpp>

namespace erkpa::tool
{

/** \brief The options of the command line with their help; the defaults named there are those of \a defaults. */
boost::program_options::options_description
listOptions (const Options &defaults);

} // namespace erkpa::tool
