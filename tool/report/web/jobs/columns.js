/** The columns of the table: what they are called, and what they say of a job. */
import { decimal, integer, significant } from '../page/format.js';

const known = (value, write) => (value === undefined || Number.isNaN(value) ? '' : write(value));

/** Those that the jobs have. first: sorted so by the first click. */
export function columnsOf(jobs) {
  const { numbers } = jobs;
  const count = (name) => (job) => known(numbers[name]?.[job], integer);
  const frames = (job) => {
    const all = known(numbers.frames?.[job], integer);
    return known(numbers.crossing_frames[job], (value) => (all === '' ? integer(value) : `${integer(value)} of ${all}`));
  };
  const columns = [
    { name: 'number', label: 'No.', title: 'Its place in the list', first: 'ascending' },
    { name: 'name', label: 'Job', title: 'As the list calls it', first: 'ascending' },
    { name: 'outcome', label: 'Outcome', title: 'The worst first', first: 'descending' },
    { name: 'crossing_frames', label: 'Frames crossing', title: 'Frames in which triangles cross', text: frames },
    { name: 'events', label: 'Events', title: 'Intersections followed through the frames', text: count('events') },
    {
      name: 'depth',
      label: 'Depth',
      title: 'The greatest depth, in the unit of its files',
      text: (job) => known(numbers.depth?.[job], (value) => significant(value, 3)),
    },
    { name: 'pairs', label: 'Pairs', title: 'Pairs of triangles that cross, in all frames', text: count('pairs') },
    {
      name: 'seconds',
      label: 'Seconds',
      title: 'To read and to check it',
      text: (job) => known(numbers.seconds?.[job], (value) => decimal(value, 2)),
    },
    { name: 'answer', label: 'What was found', title: null },
  ];
  const always = ['number', 'name', 'outcome', 'answer'];
  return columns.filter(({ name }) => always.includes(name) || name in numbers);
}
