# Makes a list of jobs in $folder: jobs.jsonl, of $1 small meshes of which some cross and one cannot be read; whole.jsonl has the lines that
# one run gives, in order. Job 20 has a model of its own, waits.obj, and no size, so that it is in shard 2 of 3. Read by the other scripts
# of this folder.
make_jobs() { # make_jobs COUNT
    printf 'v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n' >"$folder/clean.obj"
    cp "$folder/clean.obj" "$folder/waits.obj"
    printf 'v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n' >"$folder/crossing.obj"
    printf 'v 0 0 0\nf 1 2 9\n' >"$folder/damaged.obj"
    awk -v folder="$folder" -v count="$1" 'BEGIN {
        for (i = 1; i <= count; i++) {
            model = i == 7 ? "damaged" : i == 20 ? "waits" : i % 3 == 0 ? "crossing" : "clean"
            size = i == 20 ? "" : sprintf(", \"size\": %d", i * 37 % 50)
            printf "{\"name\": \"job %d\", \"model\": \"%s/%s.obj\"%s}\n", i, folder, model, size
        }
    }' >"$folder/jobs.jsonl"
}

run_whole() {
    rm -f "$folder/whole.jsonl"
    "$CSCD" check --list "$folder/jobs.jsonl" --results "$folder/whole.jsonl" --threads 1 --quiet 2>/dev/null || [ $? = 1 ]
    "$CSCD" merge "$folder/whole.jsonl" -o "$folder/expected.jsonl" --quiet 2>/dev/null || [ $? = 1 ]
}

# expect_merged FILE: it has the bytes of one run.
expect_merged() {
    cmp "$1" "$folder/expected.jsonl" || {
        echo "$1 differs from the results of one run"
        exit 1
    }
}
