// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace erkpa::tool
{

/** \brief Undoes the LZF compression of PCD files; whatever the bytes are, nothing outside is read or
 * written.
 *
 * PCL's decoder lives in pcl_io, which takes longer to load than most clouds to mesh.
 * \param[in] bytes compressed
 * \param[in,out] output as long as what comes out
 * \return false where the bytes are not such data, or not of that length
 */
bool
decompressLzf (std::string_view bytes, std::vector<std::uint8_t> &output);

} // namespace erkpa::tool
