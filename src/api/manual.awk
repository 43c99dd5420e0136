# Makes the manual page corcast.h(3) of the header: a comment becomes text, code stays as it is.
#     awk -v version=0.1.0 -f manual.awk corcast.h

function escape(line) {
    gsub(/\\/, "\\e", line)
    gsub(/-/, "\\-", line)
    return line ~ /^[.']/ ? "\\&" line : line
}

function put_code(line) {
    if (!in_code)
        print ".PP\n.nf"
    in_code = 1
    print escape(line)
}

function end_code() {
    if (in_code)
        print ".fi"
    in_code = 0
}

BEGIN {
    printf ".TH CORCAST.H 3 \"\" \"corcast %s\"\n", version
    print ".SH NAME\ncorcast.h \\- grow, read, draw, export and check arterial trees"
    print ".SH SYNOPSIS\n.B #include <corcast.h>\n.PP\n.B cc ... $(pkg\\-config \\-\\-cflags \\-\\-libs corcast)"
    print ".SH DESCRIPTION"
}

/^\/\* ---- / {
    end_code()
    title = $3
    for (i = 4; i < NF - 1; i++)
        title = title " " $i
    print ".SH " toupper(title)
    next
}

/^#if|^#endif|^#else|^#include|^#ifdef|^extern "C"|^}$|^#define (CORCAST_H|CORCAST_API)/ { next }

# A comment of its own, which says what the code below is.
/^\/\*/ { in_comment = 1; end_code(); print ".PP"; sub(/^\/\* ?/, "") }

in_comment {
    ends = sub(/ *\*\/$/, "")
    sub(/^ \* ?/, "")
    sub(/^ \*$/, "")
    if ($0 == "")
        print ".PP"
    else if ($0 ~ /^    |^[a-zA-Z]+  +[^ ]/) # an example, or the name of a parameter
        print ".br\n" escape($0)
    else
        print escape($0)
    if (ends)
        in_comment = 0
    next
}

/./ { sub(/^CORCAST_API /, ""); put_code($0) }

/^$/ { end_code() }

END {
    end_code()
    print ".SH SEE ALSO\n.BR corcast (1)"
}
