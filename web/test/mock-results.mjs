export const results = () => null;
