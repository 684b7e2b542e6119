# Turns the plain comments of the public headers into ones that doxygen reads, with as many lines, so that its
# warnings name the headers' lines.
#   the first of a file             about the file; that of cscd.h, what holds for all, is the main page
#   a comment after code            about all that the code declares: it moves before it
#   a comment on lines of its own   about what follows: in a structure all members up to a blank line, else one
#                                   function and the _from_name after it
#   /* ---- title ---- */           a group, up to the next one; within a class, nothing

# "   word  meaning" in a comment is an item of a list.
function item(line) {
    if (line ~ /^ \*   [A-Za-z]+  +/) sub(/^ \*   [A-Za-z]+ +/, " * - **" $2 "** ", line)
    return line
}

# The words of a line of a comment.
function words(line) {
    sub(/^.*\/\* */, "", line)
    sub(/^ *\* */, "", line)
    sub(/ *\*\/ *$/, "", line)
    return line
}

# "double u, v;" as two declarations with the comment each, for doxygen gives it to one. first_has_it: it stands
# before the first already.
function documented(declaration, comment, first_has_it,    result, names, count, type, i) {
    comment = "/** " comment " */ "
    if (!in_structure || declaration !~ /^[^()]*, [^()]*;$/) return (first_has_it ? "" : comment) declaration
    count = split(declaration, names, /, |;/) - 1
    type = names[1]
    sub(/[*]*[a-z_0-9]+(\[[0-9]\])?$/, "", type)
    sub(/.* /, "", names[1])
    for (i = 1; i <= count; i++) result = result (i == 1 && first_has_it ? "" : comment) type names[i] "; "
    return result
}

function finish_trailing() {
    print documented(code, said, 0)
    while (extra-- > 0) print "" # for the lines of the comment
    trailing = 0
    said = ""
}

FNR == 1 { print (FILENAME ~ /\/cscd\.h$/ ? "/** @mainpage " : "/** @about ") words($0) (/\*\// ? " */" : ""); inside = !/\*\//; next }

trailing { said = said " " words($0); extra++; if (/\*\//) finish_trailing(); next }

inside { said = said " " words($0); inside = !/\*\//; print item($0); next }

/^\/\* ---- / {
    gsub(/^\/\* -+ | -+ \*\/$/, "")
    print (grouped ? "/** @} */ " : "") "/** @name " $0 " */ /** @{ */"
    grouped = 1
    next
}

# A title within a class, which is about no function.
/^ +\/\* ---- .*\*\/$/ { print ""; said = ""; next }

# The second one, after all declarations.
/^#ifdef __cplusplus/ && ++openings == 2 && grouped { print "/** @} */"; print; next }

/^ *\/\* / {
    said = words($0)
    fresh = 1
    inside = !/\*\//
    sub(/\/\*/, "/**")
    print
    next
}

/[^ ].*\/\* / {
    said = words($0)
    code = $0
    sub(/ *\/\*.*/, "", code)
    trailing = 1
    extra = 0
    if (/\*\//) finish_trailing()
    if (/^typedef struct /) in_structure = 1
    next
}

/^$/ { said = "" }

/^typedef struct .*\{$/ { in_structure = 1; said = "" }

/^\}/ { in_structure = 0 }

in_structure && /^ .*;$/ && said != "" { print documented($0, said, fresh); fresh = 0; next }

/^CSCD_API .*_from_name\(/ && said != "" { print documented($0, said, 0); next }

{ print }
