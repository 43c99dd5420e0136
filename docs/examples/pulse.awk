# awk -f pulse.awk tree.swc > pulse.csv: a wave of pressure (mmHg) that runs from the root of a tree
# outwards at 60 mm a beat, in 24 frames of a beat of 0.8 s.
BEGIN {
    frames = 24; beat = 0.8; reach = 60
    printf "id"
    for (k = 0; k < frames; k++) printf ",%.4f", k * beat / frames
    print ""
}
/^#/ { next }
$7 < 0 { x[$1] = $3; y[$1] = $4; z[$1] = $5; next }
{
    p = $7; x[$1] = $3; y[$1] = $4; z[$1] = $5
    way[$1] = way[p] + sqrt((x[$1] - x[p])^2 + (y[$1] - y[p])^2 + (z[$1] - z[p])^2)
    printf "%d", $1
    for (k = 0; k < frames; k++) {
        phase = k / frames - way[$1] / reach
        phase -= phase < 0 ? int(phase) - 1 : int(phase)
        printf ",%.2f", 80 + 40 * exp(-18 * (phase - 0.2)^2)
    }
    print ""
}
