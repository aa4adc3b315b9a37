// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/xmp_packet.h"

#include "vera/drawing/document_text.h"

#include <fmt/format.h>

namespace vera::detail {

namespace {

/// A text that could be there in several languages; nothing where it is empty.
std::string alternative(std::string_view element, std::string_view text) {
    if (text.empty())
        return {};
    return fmt::format(
        "<{0}><rdf:Alt><rdf:li xml:lang=\"x-default\">{1}</rdf:li></rdf:Alt></{0}>\n",
        element,
        xml_text(text));
}

} // namespace

std::string xmp_packet(std::string_view title, std::string_view description) {
    // Its beginning, with the mark of UTF-8, and the id are the same in all packets: programs that
    // do not know the format of a file look for them.
    return "<?xpacket begin=\"\xEF\xBB\xBF\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
           "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n"
           "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
           "<rdf:Description rdf:about=\"\"\n"
           " xmlns:dc=\"http://purl.org/dc/elements/1.1/\"\n"
           " xmlns:pdf=\"http://ns.adobe.com/pdf/1.3/\"\n"
           " xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\">\n"
           "<dc:format>application/pdf</dc:format>\n"
        + alternative("dc:title", title) + alternative("dc:description", description)
        + "<xmp:CreatorTool>VERA</xmp:CreatorTool>\n"
          "<pdf:Producer>VERA</pdf:Producer>\n"
          "</rdf:Description>\n"
          "</rdf:RDF>\n"
          "</x:xmpmeta>\n"
          "<?xpacket end=\"r\"?>";
}

} // namespace vera::detail
